//! What the effects of a model give along a measured motion.

use super::equation::Equation;
use super::motion::Motion;
use super::term::Place;
use core::f64::consts::TAU;
use servoid_engine::problem::{Candidate, Data};
use shared::effects::{Lowered, MAX_EFFECTS, Memory, Shaft, WHOLE_DROP, Winding};

/// Rounds in which a current is found that a drop lessens.
const ROUNDS: usize = 4;

/// What effects give in the interval that begins at each sample, V referred to the winding.
pub struct Given {
    /// As a torque on the shaft.
    pub torque: Vec<f64>,
    /// As a voltage at the winding.
    pub voltage: Vec<f64>,
}

impl Given {
    /// By a candidate's effects along the motion of a recording, with what they remember; a load behind a spring or a gap and an error
    /// of the angle give nothing.
    pub fn by(data: &Data, candidate: &Candidate, motion: &Motion) -> Self {
        let effects = Lowered::<f64>::new(&candidate.effects, &data.units);
        let units = &data.units;
        let machine = &candidate.machine;
        let mut memory = Default::default();
        let each = (0..data.len()).map(|k| {
            if data.recordings.is_first(k) {
                memory = Default::default();
            }
            let (seconds, speed) = (motion.seconds[k], motion.speed[k]);
            let gained = match k + 1 {
                next if next < data.len() && k > 0 => {
                    0.5 * (motion.speed[next] - motion.speed[k - 1])
                }
                _ => 0.0,
            };
            let length = seconds / units.interval;
            let per_second = if seconds > 0.0 { 1.0 / seconds } else { 0.0 };
            let volts = effects.drive(data.command[k]);
            let current = motion.current[k] / units.volts;
            let mut shaft = Shaft {
                travel: speed * seconds / TAU,
                speed_change: gained / units.speed,
                volts,
                temperature: data.temperature(k),
                inertia: machine.inertia * per_second * units.speed / units.volts,
                length,
                per_length: per_second * units.interval,
                ..Shaft::at(motion.angle[k] / TAU, speed / units.speed, current)
            };
            let winding = carried(&effects, &mut shaft, &memory);
            let current = shaft.current;
            let stiff = effects.stiff(&shaft, &memory).torque;
            let lost = effects.lost_torque(&shaft, &memory);
            let torque = effects.torque(&shaft, &memory) + stiff;
            shaft.transmitted = current + torque - lost;
            let budget = effects.friction(&shaft);
            let sign = if speed == 0.0 { 0.0 } else { speed.signum() };
            let friction = budget.moving * sign + budget.bias;
            let emf = machine.kb * speed / units.volts;
            let brush = &effects.brush;
            let knees = match brush.knee > 0.0 {
                true => (current.abs() / brush.knee).min(WHOLE_DROP),
                false => WHOLE_DROP,
            };
            let dropped = brush.drop * brush.lost(knees).0 * current.signum();
            let taken = winding.resistance * current + winding.back_emf * emf + dropped;
            effects.remember(&mut memory, &shaft);
            (
                -(torque + lost + friction) * units.volts,
                (volts - data.command[k] + winding.volts - taken) * units.volts,
            )
        });
        each.collect()
    }

    /// What it gives at the rows of an equation.
    pub(super) fn seen(&self, equation: &Equation<'_>) -> Vec<f64> {
        let torque = equation.seen(&self.torque, Place::Torque);
        let voltage = equation.seen(&self.voltage, Place::Voltage);
        torque.iter().zip(&voltage).map(|(a, b)| a + b).collect()
    }
}

/// What the winding's effects give, and in `shaft` the current that they leave of the one without them (Newton's method).
fn carried(
    effects: &Lowered<f64>,
    shaft: &mut Shaft<f64>,
    memory: &[Memory<f64>; MAX_EFFECTS],
) -> Winding<f64> {
    let without = shaft.current;
    let mut winding = effects.winding(shaft, memory);
    for _ in 0..ROUNDS {
        if winding.resistance == 0.0 {
            break;
        }
        shaft.current = (without + winding.volts) / (1.0 + winding.resistance);
        winding = effects.winding(shaft, memory);
    }
    winding
}

/// From the torque and the voltage of each interval.
impl FromIterator<(f64, f64)> for Given {
    fn from_iter<I: IntoIterator<Item = (f64, f64)>>(each: I) -> Self {
        let (torque, voltage) = each.into_iter().unzip();
        Given { torque, voltage }
    }
}
