//! The linear motor beside what it lacks: a fit without the law bends all of its parameters, by as much as makes currents and time
//! constants useless.

use super::equation::Equation;
use super::term::{Place, Term};
use crate::fit::scores::motor_coefficients;
use servoid_engine::problem::{Candidate, Data};
use shared::motor::Machine;

/// Rounds: what a torque leads by follows from the winding's time constant, which is found beside it.
const ROUNDS: usize = 2;
/// Longest electrical time constant, parts of the mechanical one.
const LONGEST: f64 = 1.0;

/// The candidate with the linear motor that regression finds beside a law that is known already, and beside friction, drag and a constant,
/// which take most of what most laws are.
pub fn refined(data: &Data, candidate: &Candidate, law: &[Term]) -> Candidate {
    let mut refined = *candidate;
    for _ in 0..ROUNDS {
        let Some(equation) = Equation::new(data, &refined) else {
            break;
        };
        let speed = &equation.motion.speed;
        let fastest = data.units.speed;
        let each = |f: &dyn Fn(f64) -> f64| speed.iter().map(|&w| f(w)).collect::<Vec<f64>>();
        let mut beside = vec![
            each(&|w| if w == 0.0 { 0.0 } else { w.signum() }),
            each(&|w| w * w.abs() / (fastest * fastest)),
            each(&|w| w.abs() / fastest),
            each(&|_| 1.0),
        ];
        let torques = law.iter().filter(|term| term.place == Place::Torque);
        beside.extend(torques.flat_map(|term| term.factors(&equation.motion)));
        let changed = equation.changes_beside(&beside);
        let Some(machine) = changed.and_then(|by| changed_by(&refined.machine, by)) else {
            break;
        };
        refined.machine = machine;
    }
    refined
}

/// The machine with other coefficients; `None` where no motor has them. Back-EMF and viscous friction share what they had.
fn changed_by(machine: &Machine<f64>, by: [f64; 3]) -> Option<Machine<f64>> {
    let before = motor_coefficients(machine);
    let [total, second, third]: [f64; 3] = core::array::from_fn(|k| before[k] - by[k]);
    if !(total > 0.0 && second > 0.0 && third.is_finite()) {
        return None;
    }
    let damping = machine.damping * total / before[0];
    let electrical = (third / second).clamp(0.0, LONGEST * second / total);
    Some(Machine {
        kb: total - damping,
        damping,
        inertia: (second - electrical * damping).max(0.1 * second),
        electrical,
    })
}
