//! A current loop, and a speed loop around it.

use super::super::error::ExportError;
use super::super::subject::Subject;
use super::design::{Method, Task, Zero};
use super::loops::{C, Open, Plant, hz};
use super::{Asked, Controllers, Section};

/// A current loop, and a speed loop around it that is computed from the same readings.
pub(super) fn close(
    subject: &Subject,
    asked: &Asked,
    plant: &Plant,
    ohm: f64,
    controllers: &mut Controllers,
) -> Result<(), ExportError> {
    let period = plant.period;
    let current = |omega: f64| plant.at(omega)[0] / ohm;
    let inner = Task {
        name: "current loop",
        flag: "--current-bandwidth",
        asked_hz: asked.current_hz,
        // The winding's own pole; back-EMF changes slowly and is left to the integral.
        zero: Zero::Pole((-period / subject.machine.electrical).exp()),
        open: Open {
            plant: &current,
            period,
        },
        inner: true,
        helps: "a shorter --sample",
    };
    let (inner, warning) = inner.close()?;
    controllers.remarks.extend(warning);
    controllers.sections.push(Section {
        name: "current_loop",
        method: Method::Cancel,
        closed: inner,
        output: "V".to_owned(),
        input: "A",
    });

    // Speed by the current that is asked for, with the inner loop closed.
    let speed = |omega: f64| -> C {
        let [current, speed] = plant.at(omega);
        let pi = inner.pi.at(omega, period);
        pi * speed / (pi * current / ohm + 1.0)
    };
    let method = asked.method.unwrap_or(Method::Symmetrical);
    let zero = match method {
        // A type-one loop follows a ramp 1/ωc late; the difference of counts is half a period late.
        Method::Symmetrical => Zero::Lags(1.0 / inner.crossover + 0.5 * period),
        Method::Cancel => {
            let machine = &subject.machine;
            if !(subject.viscous_is_apart() && machine.damping > 0.0) {
                return Err(ExportError::Undetermined {
                    format: "--method cancel of a speed loop around a current loop",
                    needs: "viscous friction apart from back-EMF".to_owned(),
                    remedy: "record a stretch of coasting with the bridge open, or use --method symmetrical or --loops voltage",
                });
            }
            Zero::Pole((-period * machine.damping / machine.inertia).exp())
        }
    };
    let outer = Task {
        name: "speed loop",
        flag: "--speed-bandwidth",
        asked_hz: asked.speed_hz,
        zero,
        open: Open {
            plant: &speed,
            period,
        },
        inner: false,
        helps: "a higher --current-bandwidth or a shorter --sample",
    };
    let (outer, warning) = outer.close()?;
    controllers.remarks.extend(warning);
    if outer.crossover > 0.5 * inner.crossover {
        controllers.remarks.push(format!(
            "speed loop: {:.1} Hz is more than half of the current loop's {:.1} Hz",
            hz(outer.crossover),
            hz(inner.crossover)
        ));
    }
    controllers.sections.push(Section {
        name: "speed_loop",
        method,
        closed: outer,
        output: "A".to_owned(),
        input: "rad/s",
    });
    Ok(())
}
