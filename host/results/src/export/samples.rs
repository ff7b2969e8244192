//! Results to try exporters on: every effect, with much and with little known.

use super::{Side, Subject};
use crate::schema::{Estimate, Identified, Model};
use servoid_engine::simulation::Method;
use servoid_identify::plan::Hypothesis;
use servoid_io::recording::Drive;
use servoid_plant as bench;
use shared::effects::Kind;

/// How much a result determines.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// All of it, the six physical parameters too.
    All,
    /// What voltage and angle tell.
    Voltage,
    /// The same without the parameters of effects and the electrical time constant.
    Response,
    /// Nothing: the search did not converge.
    Nothing,
    /// All that is there, behind a current loop.
    Current,
}

pub const KNOWN: [Known; 5] = [
    Known::All,
    Known::Voltage,
    Known::Response,
    Known::Nothing,
    Known::Current,
];

/// What stands for a number that is not determined: its digits must never be seen.
pub const UNDETERMINED: f64 = 0.773_462_519_1;
pub const DIGITS: &str = "77346";

/// A motor of the bench without effects of its own.
pub fn linear(motor: &bench::Machine, known: Known) -> Identified {
    result(motor, &[], known)
}

/// A result with these effects, typical for the motor.
pub fn result(motor: &bench::Machine, kinds: &[Kind], known: Known) -> Identified {
    let mut hypothesis = Hypothesis::typical(Kind::Coulomb, motor);
    (hypothesis.effects, hypothesis.values) = (Vec::new(), Vec::new());
    for &kind in kinds {
        let one = Hypothesis::typical(kind, motor);
        hypothesis.effects.extend(one.effects);
        hypothesis.values.extend(one.values);
    }
    if known == Known::Current {
        hypothesis.machine.kb = 0.0;
        hypothesis.machine.electrical = 0.0;
    }
    let machine = hypothesis.machine;
    let mut model = Model::of(&hypothesis.candidate().expect("a model"), Method::default());
    if matches!(known, Known::Response | Known::Nothing) {
        for parameter in &mut model.parameters {
            parameter.value = UNDETERMINED;
        }
    }
    let mut parameters = Vec::new();
    let mut add = |name: &str, value: f64, unit: &str, determined: bool| {
        parameters.push(Estimate {
            name: name.to_owned(),
            value: if determined { value } else { UNDETERMINED },
            unit: unit.to_owned(),
            std: determined.then_some(1e-4 * value.abs()),
            identifiable: determined,
            spread: None,
            at_bound: false,
            usual: None,
            systematic: Vec::new(),
        });
    };
    if known == Known::Current {
        add("inertia", machine.inertia, "V*s^2/rad", true);
        add("damping", machine.damping, "V*s/rad", true);
    } else {
        let response = machine.response();
        let some = known != Known::Nothing;
        let more = matches!(known, Known::All | Known::Voltage);
        add("gain", response.gain, "rad/(s*V)", some);
        add("a1", response.a1, "s", some);
        add("electrical_time_constant", machine.electrical, "s", more);
        let part = machine.damping * response.gain;
        add("viscous_part", part, "1", known == Known::All);
    }
    for parameter in &model.parameters {
        let determined = !matches!(known, Known::Response | Known::Nothing);
        add(
            &parameter.name,
            parameter.value,
            &parameter.unit,
            determined,
        );
    }
    if known == Known::All {
        add("resistance", motor.resistance_ohm, "ohm", true);
        add("inductance", motor.inductance_h, "H", true);
        add("kt", motor.kt_n_m_a, "N*m/A", true);
        add("kb", motor.kb_v_s_rad, "V*s/rad", true);
        add("inertia", motor.inertia_kg_m2, "kg*m^2", true);
        add("viscous", motor.viscous_n_m_s, "N*m*s/rad", true);
    }
    Identified {
        schema: "servoid.fit/1".to_owned(),
        // As hostile as a name can be.
        recording: Some("a */ b --> <c> \"d\n.csv".to_owned()),
        drive: match known {
            Known::Current => Drive::Current,
            _ => Drive::Voltage,
        },
        supply_v: Some(motor.supply_v),
        counts_per_rev: Some(2000.0),
        sample_s: Some(1e-3),
        converged: known != Known::Nothing,
        grade: None,
        parameters,
        model,
        place: "model",
    }
}

/// The subject of a result.
pub fn subject(result: &Identified, side: Side) -> Subject {
    Subject::new(result, "fit --> */.json", side).expect("a subject")
}
