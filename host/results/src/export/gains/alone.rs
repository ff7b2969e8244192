//! A speed loop without a current loop inside.

use super::super::error::ExportError;
use super::super::subject::Subject;
use super::design::{Method, Task, Zero};
use super::loops::{Open, Plant};
use super::{Asked, Controllers, Section};
use servoid_io::recording::Drive;

/// One speed loop whose output is the motor's command.
pub(super) fn close(
    subject: &Subject,
    asked: &Asked,
    plant: &Plant,
    controllers: &mut Controllers,
) -> Result<(), ExportError> {
    let period = plant.period;
    let Some([slow, _]) = plant.poles() else {
        return Err(ExportError::Loop(
            "the motor's two poles are complex (L/R is more than a quarter of its mechanical time constant): a PI from speed to \
             volts has no pole to cancel; fit again with --known resistance_ohm=…, so that a current loop can be closed"
                .to_owned(),
        ));
    };
    let method = asked.method.unwrap_or(match subject.drive {
        Drive::Voltage => Method::Cancel,
        Drive::Current | Drive::Torque => Method::Symmetrical,
    });
    let zero = match method {
        Method::Cancel if slow < 1.0 => Zero::Pole(slow),
        Method::Cancel => {
            return Err(ExportError::Loop(
                "--method cancel: the motor has no viscous friction, so that its pole is an integrator and nothing of the integral \
                 would be left; use --method symmetrical"
                    .to_owned(),
            ));
        }
        // Dead time 1.5 periods, half of one for the difference of counts, and the winding.
        Method::Symmetrical => Zero::Lags(2.0 * period + subject.machine.electrical),
    };
    let speed = |omega: f64| plant.at(omega)[1];
    let task = Task {
        name: "speed loop",
        flag: "--speed-bandwidth",
        asked_hz: asked.speed_hz,
        zero,
        open: Open {
            plant: &speed,
            period,
        },
        inner: false,
        helps: "a shorter --sample",
    };
    let (closed, warning) = task.close()?;
    controllers.remarks.extend(warning);
    controllers.sections.push(Section {
        name: "speed_loop",
        method,
        closed,
        output: subject.unit_shown("V"),
        input: "rad/s",
    });
    Ok(())
}
