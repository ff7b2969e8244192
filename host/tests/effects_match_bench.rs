//! The model against the virtual bench: with the true parameters, every effect of the catalogue on
//! every machine leaves nothing but the encoder's rounding.
//!
//! The two share no code. The bench integrates plain SI equations finely; the model takes a few
//! exact maps a sample. Where both agree over twenty seconds to a fraction of a count, two
//! derivations agree. This file holds the one thing between them: SI parameters of the bench in the
//! volts-referred terms of the model.

use host::bench::{Bench, DriveSample, Hidden, Machine, PRESETS, Run};
use shared::cost::Cost;
use shared::effects::{EffectSet, Kind};
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::excite::{COMMISSIONING, Experiment, commands};
use shared::model::{Model, Plan, State};
use shared::motor::Physical;
use shared::units::PerUnit;
use std::f64::consts::TAU;
use std::ops::Range;

const COUNTS_PER_REV: u32 = 2000;
const INTERVAL_S: f64 = 1e-3;
const START_RAD: f64 = 0.3;
const SEED: u64 = 1;

/// The bench's machine in the model's terms.
fn physical(machine: &Machine) -> Physical<f64> {
    Physical {
        resistance: machine.resistance_ohm,
        inductance: machine.inductance_h,
        kt: machine.kt_n_m_a,
        kb: machine.kb_v_s_rad,
        inertia: machine.inertia_kg_m2,
        viscous: machine.viscous_n_m_s,
    }
}

/// The effect's parameters in the model's terms: torques as the volts that the winding spends on
/// them, currents as the volts across the resistance.
fn volts_referred(hidden: &Hidden, machine: &Machine) -> Vec<f64> {
    let p = |key: &str| {
        let mut all = hidden.parameters();
        all.find(|(name, ..)| *name == key)
            .unwrap_or_else(|| panic!("{} has no parameter {key}", hidden.name()))
            .1
    };
    let r = machine.resistance_ohm;
    let supply = machine.supply_v;
    let volts = |torque: f64| torque * r / machine.kt_n_m_a;
    let inertia = machine.inertia_kg_m2;
    match hidden.name() {
        "coulomb" | "load_torque" => vec![volts(p("torque"))],
        "asym_coulomb" => vec![volts(p("forward")), volts(p("backward"))],
        "stribeck" => vec![
            volts(p("coulomb")),
            volts(p("extra")),
            p("speed"),
            p("exponent"),
        ],
        "windage" => vec![volts(p("drag"))],
        // A·sin(nθ + φ) against rotation.
        "cogging" => {
            let (sin, cos) = p("phase").sin_cos();
            let torque = volts(p("torque"));
            vec![torque * sin, torque * cos, p("order")]
        }
        "unbalance" => {
            let (sin, cos) = p("phase").sin_cos();
            let torque = volts(p("torque"));
            vec![torque * sin, torque * cos]
        }
        "backlash" => vec![
            p("gap"),
            p("load_share"),
            1.0 / p("contact_hz"),
            p("damping"),
        ],
        "compliance" => {
            let reduced = p("load_share") * (1.0 - p("load_share")) * inertia;
            let period = TAU * (p("compliance") * reduced).sqrt();
            vec![period, p("load_share"), p("damping")]
        }
        "brush_drop" => vec![p("drop"), p("knee") * r],
        "dead_zone" => vec![p("width")],
        "supply_sag" => vec![p("resistance") / r / (supply * supply)],
        "voltage_sat" => vec![supply - p("lost")],
        "torque_sat" => vec![p("cubic") / (r * r)],
        "l_sat" => vec![p("falloff") / (r * r)],
        // dΔT/dt = (Rth·R(1 + αΔT)·i² − ΔT)/τ with y = α·ΔT and c = R·i.
        "heating" => vec![
            p("copper") * p("thermal_resistance") / (r * p("time_constant")),
            p("time_constant"),
            p("magnet") / p("copper"),
        ],
        "delay" => vec![p("time")],
        "enc_ecc" => {
            let (sin, cos) = p("phase").sin_cos();
            vec![p("amplitude") * sin, p("amplitude") * cos]
        }
        "missed_counts" => {
            // Mean size of a burst, and bursts per radian.
            let size = (1.0 + p("largest")) / 2.0;
            let per_rad = p("rate") / machine.top_speed_rad_s();
            vec![size * per_rad * TAU / f64::from(COUNTS_PER_REV), 0.0]
        }
        "offset_voltage" => vec![p("offset")],
        "lugre" => {
            let torque = p("coulomb");
            let stiffness = torque * (1.0 + p("extra")) / p("presliding");
            let damping = 2.0 * p("damping") * (stiffness * inertia).sqrt();
            vec![
                volts(torque),
                p("extra"),
                p("speed"),
                p("presliding"),
                damping / stiffness,
            ]
        }
        "asym_viscous" => vec![volts(p("forward")), volts(p("backward"))],
        "load_friction" => vec![p("share")],
        name => panic!("no mapping for {name}"),
    }
}

fn record(machine: Machine, effects: Vec<Hidden>, plan: &[Experiment]) -> Run {
    let drive: Vec<DriveSample> = commands::<f64>(plan, INTERVAL_S, SEED)
        .map(|command| DriveSample {
            volts: command.drive * machine.supply_v,
            enabled: command.enabled,
        })
        .collect();
    let bench = Bench {
        effects,
        counts_per_rev: COUNTS_PER_REV,
        sample_s: INTERVAL_S,
        seed: SEED,
        start_angle_rad: Some(START_RAD),
        ..Bench::new(machine)
    };
    bench.run(&drive).expect("the bench runs")
}

/// RMS error of the model in counts, with the true parameters and the mean error removed.
fn rms(machine: &Machine, effects: &[Hidden], run: &Run, substeps: u16) -> f64 {
    let mut set = EffectSet::default();
    for hidden in effects {
        let kind = Kind::by_name(hidden.name()).expect("the catalogues agree");
        set.push(kind, &volts_referred(hidden, machine))
            .expect("a valid effect");
    }
    let units = PerUnit::new(
        machine.supply_v,
        1.3 * machine.top_speed_rad_s(),
        INTERVAL_S,
        f64::from(COUNTS_PER_REV),
    )
    .expect("valid bases");
    let plan = Plan {
        effects: set,
        substeps,
        ..Plan::linear(physical(machine).machine(), units)
    };
    let model = Model::<f64>::new(&plan).expect("a valid model");
    let mut state = State::at(START_RAD * f64::from(COUNTS_PER_REV) / TAU, 0.0);
    let errors: Vec<f64> = (0..run.counts.len())
        .map(|k| {
            let error = model.reading(&state) - run.counts[k] as f64 - FLOOR_OFFSET_COUNTS;
            model.step(
                &mut state,
                run.voltage_v[k] / machine.supply_v,
                !run.enabled[k],
            );
            error
        })
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    let squares = errors.iter().map(|e| (e - mean).powi(2)).sum();
    Cost::rms(squares, errors.len())
}

/// Limits on the error that the true parameters leave, counts RMS: the encoder's floor is 0.2887. Below
/// it by much would be as wrong as above.
const LIMITS: Range<f64> = 0.24..0.32;
/// Substeps at which every effect is within them.
const FINE: u16 = 8;

/// Substeps of a quick search, and the limits there.
const COARSE: u16 = 2;
const COARSE_LIMITS: Range<f64> = 0.24..0.36;
/// Bristles that bend within hundredths of a sample want more substeps on a quick motor.
const COARSE_BRISTLE_LIMITS: Range<f64> = 0.24..0.6;

/// Counts are lost at random on the bench: no parameters reproduce the draw.
const RANDOM: [Kind; 1] = [Kind::MissedCounts];

#[test]
fn true_parameters_leave_the_encoders_own_error_for_every_effect_on_every_machine() {
    for name in PRESETS {
        let machine = Machine::preset(name).expect("a preset");
        for kind in Kind::ALL.iter().filter(|kind| !RANDOM.contains(kind)) {
            let hidden = vec![Hidden::typical(kind.name(), &machine).expect("in the catalogue")];
            let run = record(machine, hidden.clone(), &COMMISSIONING);
            let coarse_limits = match kind {
                Kind::Lugre => COARSE_BRISTLE_LIMITS,
                _ => COARSE_LIMITS,
            };
            for (substeps, limits) in [(COARSE, coarse_limits), (FINE, LIMITS)] {
                let error = rms(&machine, &hidden, &run, substeps);
                let case = format!("{name} with {} at {substeps} substeps", kind.name());
                println!("{case}: {error:.4} counts RMS");
                assert!(limits.contains(&error), "{case}: {error} counts RMS");
            }
        }
    }
}
