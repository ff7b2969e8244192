//! What knowing a motor's effects is good for: its speed loop on the fitted model, with the feed-forward of a linear motor, and with friction,
//! constant load, cogging and backlash compensated as well.
//!
//! The loop is the one that the format `gains` writes for volts. It reads the speed as the encoder's counts over a period, its command acts
//! one period later, and the model follows it with all its effects. The wanted speed is slow and reverses: there friction and cogging tell.

mod closed_loop;
mod crossing;

use crate::export::gains::feed_forward::FeedForward;
use crate::export::gains::{self, Asked, Loops, Section};
use crate::export::{ExportError, Options, Subject, Written};
use closed_loop::ClosedLoop;
pub use crossing::Crossing;
use servoid_engine::problem::Candidate;
use servoid_io::recording::Drive;
use shared::units::PerUnit;

/// Samples that are drawn.
const DRAWN: usize = 600;

/// A motor in a speed loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Remedy {
    /// Proportional and integral gain, V per rad/s and V per rad.
    pub gains: [f64; 2],
    /// What is fed forward.
    pub feed_forward: FeedForward,
    /// Effects of the angle that are compensated by a table.
    pub by_angle: Vec<&'static str>,
    /// How the gap of a coupling is crossed, where the model has one.
    pub crossing: Option<Crossing>,
    /// Times of the samples that are drawn, s.
    pub time_s: Vec<f64>,
    /// Speed that is wanted there, rad/s.
    pub wanted: Vec<f64>,
    /// The speed there with a linear motor's feed-forward, rad/s: the motor's, or its load's behind a gap.
    pub before: Vec<f64>,
    /// With what is known of its effects, rad/s.
    pub after: Vec<f64>,
    /// RMS of wanted less true speed before and after, rad/s.
    pub rms: [f64; 2],
    /// RMS of wanted less true angle before and after, about their mean, rad. Behind a gap this is what falls.
    pub rms_angle: [f64; 2],
}

/// Tries the loop of a motor that was driven by volts.
///
/// # Errors
/// A response or a loop that is not determined; a model that cannot run.
pub fn remedy(
    subject: &Subject,
    candidate: &Candidate,
    units: PerUnit<f64>,
) -> Result<Remedy, ExportError> {
    if subject.drive != Drive::Voltage {
        return Err(ExportError::CurrentDriven {
            format: "the speed loop",
        });
    }
    let options = Options {
        sample_s: Some(units.interval),
        gains: Asked {
            loops: Some(Loops::Voltage),
            ..Asked::default()
        },
        ..Options::default()
    };
    let controllers = gains::design(subject, &options)?;
    let speed: &Section = controllers
        .section("speed_loop")
        .ok_or_else(|| ExportError::Loop("there is no speed loop for this motor".to_owned()))?;
    let pi = speed.closed.pi;
    let feed_forward = FeedForward::of(subject, &mut Written::new(subject));
    let crossing = Crossing::of(candidate, speed.closed.crossover);
    let closed = ClosedLoop {
        candidate,
        units,
        pi,
        feed_forward: &feed_forward,
        crossing,
    };
    let (wanted, before) = closed.run(false)?;
    let (_, after) = closed.run(true)?;
    let step = wanted.len().div_ceil(DRAWN).max(1);
    let pick = |of: &[f64]| of.iter().copied().step_by(step).collect::<Vec<f64>>();
    let judged = wanted.len() / 2;
    let errors = |speed: &[f64]| -> Vec<f64> {
        let errors = wanted.iter().zip(speed).skip(judged);
        errors.map(|(wanted, speed)| wanted - speed).collect()
    };
    let (before_errors, after_errors) = (errors(&before), errors(&after));
    let angle = |errors: &[f64]| about_mean(&summed(errors, units.interval));
    Ok(Remedy {
        gains: [pi.kp, pi.ki],
        by_angle: closed_loop::by_angle(candidate)
            .iter()
            .map(|(kind, _)| kind.name())
            .collect(),
        crossing,
        time_s: (0..wanted.len())
            .step_by(step)
            .map(|k| k as f64 * units.interval)
            .collect(),
        rms: [rms(&before_errors), rms(&after_errors)],
        rms_angle: [angle(&before_errors), angle(&after_errors)],
        wanted: pick(&wanted),
        before: pick(&before),
        after: pick(&after),
        feed_forward,
    })
}

fn rms(of: &[f64]) -> f64 {
    (of.iter().map(|x| x * x).sum::<f64>() / of.len() as f64).sqrt()
}

fn summed(rates: &[f64], interval: f64) -> Vec<f64> {
    let sums = rates.iter().scan(0.0, |sum, rate| {
        *sum += rate * interval;
        Some(*sum)
    });
    sums.collect()
}

/// RMS of what departs from the mean.
fn about_mean(of: &[f64]) -> f64 {
    let mean = of.iter().sum::<f64>() / of.len() as f64;
    rms(&of.iter().map(|x| x - mean).collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::Side;
    use crate::schema;
    use servoid_engine::problem::Data;
    use servoid_identify::fit::Options as FitOptions;
    use servoid_identify::{Silent, identify};
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use shared::effects::Kind;

    #[test]
    fn what_is_known_of_an_effect_makes_the_loop_follow_better() {
        // A load that is constant is the integrator's already.
        for (name, kind, least) in [
            ("coulomb", Kind::Coulomb, 2.0),
            ("cogging", Kind::Cogging, 1.5),
            ("load_torque", Kind::LoadTorque, 0.9),
            ("backlash", Kind::Backlash, 1.3),
        ] {
            let hidden = Hidden::typical(name, &showcase::machine()).expect("an effect");
            let recording =
                showcase::record(std::slice::from_ref(&hidden), 1, "bench").expect("a recording");
            let asked = FitOptions {
                effects: vec![kind],
                ..FitOptions::default()
            };
            let fit = identify(&recording, &asked, &Silent::default()).expect("a fit");
            let data = Data::new(&recording).expect("data");
            let json = serde_json::to_string(&schema::Fit::new(&fit, &data, None)).expect("JSON");
            let result = schema::Identified::parse(&json).expect("a result");
            let subject = Subject::new(&result, "test", Side::Motor).expect("a subject");
            let found = remedy(&subject, &fit.candidate, data.units).expect("a loop");
            let [before, after] = match kind {
                Kind::Backlash => found.rms_angle,
                _ => found.rms,
            };
            println!("{name}: {:?} rad/s, {:?} rad", found.rms, found.rms_angle);
            assert!(before >= least * after, "{name}: {before} to {after}");
            assert!(after < 0.5 * found.wanted.iter().fold(0.0, |m, w| w.max(m)));
        }
    }
}
