//! Exported numbers mean in the other program what they mean in the model.

use super::super::discrete::step;
use super::super::gains::feed_forward::FeedForward;
use super::super::samples::{Known, result, subject};
use super::super::{Format, Side, Subject, Written};
use super::{OUTPUT, write};
use servoid_plant as bench;
use shared::effects::Kind;
use shared::model::{Plan, State};
use shared::units::PerUnit;
use testing::motion;

/// Steps of 1 ms.
pub(super) const STEPS: usize = 400;

/// Volts at a step.
pub(super) fn command(k: usize) -> f64 {
    4.0 * (k as f64 * 0.02).sin() + 2.0
}

/// Speed after each step of the model itself, rad/s.
pub(super) fn speeds(subject: &Subject) -> Vec<f64> {
    let units = PerUnit::new(12.0, 700.0, 1e-3, 2000.0).expect("units");
    let mut plan = Plan::linear(subject.machine, units);
    for term in &subject.terms {
        plan.effects
            .push(term.kind, &term.values)
            .expect("an effect");
    }
    let commands: Vec<(f64, bool)> = (0..STEPS).map(|k| (command(k) / 12.0, false)).collect();
    let motion = motion::exact(&plan, State::default(), &commands).expect("a model");
    motion.speeds[1..]
        .iter()
        .map(|speed| speed * 700.0)
        .collect()
}

#[test]
fn the_exported_step_takes_a_torque_as_the_model_does() {
    let motor = bench::Machine::gearmotor();
    let subject = subject(
        &result(&motor, &[Kind::LoadTorque], Known::All),
        Side::Motor,
    );
    let by = step(&subject, 1e-3).expect("a step");
    let torque = subject.terms[0].values[0];
    let (mut c, mut w) = (0.0, 0.0);
    for (k, truth) in speeds(&subject).into_iter().enumerate() {
        let row = |k: usize, u: f64| {
            let [by_c, by_w] = by.state[k];
            by_c * c + by_w * w + by.state_by_command[k] * u + by.by_torque[k] * torque
        };
        let (dc, dw) = (row(0, command(k)), row(1, command(k)));
        (c, w) = (c + dc, w + dw);
        assert!((w - truth).abs() < 1e-6, "step {k}: {w}, not {truth}");
    }
}

#[test]
fn feed_forward_asks_for_the_voltage_that_moved_the_motor() {
    // Slow motors whose winding is fast: what a2 adds with the jerk is small.
    for (name, kinds) in [
        ("gearmotor", vec![Kind::Coulomb]),
        ("coreless_24v", vec![Kind::Coulomb, Kind::LoadTorque]),
        ("gearmotor", vec![Kind::LoadTorque, Kind::OffsetVoltage]),
        ("gearmotor", vec![Kind::DeadZone, Kind::Coulomb]),
        ("coreless_24v", vec![]),
    ] {
        let motor = bench::Machine::preset(name).expect("a preset");
        let subject = subject(&result(&motor, &kinds, Known::All), Side::Motor);
        let feed = FeedForward::of(&subject, &mut Written::new(&subject));
        let speeds = speeds(&subject);
        let mut seen = 0;
        for k in 10..STEPS - 1 {
            let (before, speed, after) = (speeds[k - 1], speeds[k], speeds[k + 1]);
            // Where it moves on: stops and reversals are friction's own affair.
            if speeds[k - 9..k + 2]
                .iter()
                .any(|w| w * speed <= 0.0 || w.abs() < 1.0)
            {
                continue;
            }
            // A dead zone has the sign of the command, and kS that of the speed: driving they are one.
            let drives = [k, k + 1].map(command);
            if kinds.contains(&Kind::DeadZone) && drives.iter().any(|u| u * speed <= speed.abs()) {
                continue;
            }
            let (k_s, k_g) = (feed.k_s.unwrap_or(0.0), feed.k_g.unwrap_or(0.0));
            let asked =
                k_s * speed.signum() + k_g + feed.k_v * speed + feed.k_a * (after - before) / 2e-3;
            // The speed at a reading lies between the command before and the one after.
            let given = 0.5 * (command(k) + command(k + 1));
            assert!(
                (asked - given).abs() < 0.06,
                "{name}, {kinds:?}, {k}: {asked} V, not {given} V"
            );
            seen += 1;
        }
        assert!(seen > 50, "{name}: {seen}");
    }
}

#[test]
fn the_output_s_numbers_are_those_of_the_motor_behind_its_gear() {
    let motor = bench::Machine::gearmotor();
    let found = result(&motor, &[Kind::Coulomb], Known::All);
    let (here, there) = (subject(&found, Side::Motor), subject(&found, OUTPUT));
    let factor =
        |name: &str| there.determined(name).expect(name) / here.determined(name).expect(name);
    for (name, expected) in [
        ("gain", 1.0 / 30.0),
        ("a1", 1.0),
        ("inertia", 900.0),
        ("viscous", 900.0),
        ("kt", 30.0),
        ("resistance", 1.0),
    ] {
        assert!((factor(name) / expected - 1.0).abs() < 1e-12, "{name}");
    }
    // The same voltage gives the torque times 30.
    let torques =
        [&here, &there].map(|s| s.terms[0].values[0] / s.volts_per_torque().expect("R/Kt"));
    assert!((torques[1] / torques[0] / 30.0 - 1.0).abs() < 1e-9);
    // With a ratio of one, both sides are one.
    let one = subject(&found, Side::Output { ratio: 1.0 });
    assert_eq!(one.values, here.values);
}

/// An attribute of an element of a MuJoCo model.
fn attribute(text: &str, element: &str, name: &str) -> Option<f64> {
    let document = roxmltree::Document::parse(text).expect("XML");
    let node = document.descendants().find(|n| n.has_tag_name(element))?;
    let value = node.attribute(name)?.split(' ').next()?;
    Some(value.parse().expect("a number"))
}

#[test]
fn a_mujoco_motor_has_the_torque_and_the_friction_of_ours() {
    let format = Format::by_name("mujoco").expect("a format");
    for name in bench::PRESETS {
        let motor = bench::Machine {
            kt_n_m_a: 0.8 * bench::Machine::preset(name).expect("a preset").kt_n_m_a,
            ..bench::Machine::preset(name).expect("a preset")
        };
        for side in [Side::Motor, OUTPUT] {
            let turns = if side == Side::Motor { 1.0 } else { 30.0 };
            let both = [Kind::Lugre, Kind::Coulomb];
            let subject = subject(&result(&motor, &both, Known::All), side);
            let text = write(format, &subject).expect("a model").text;
            let of_motor = |name| attribute(&text, "dcmotor", name).expect(name);
            let of_joint = |name| attribute(&text, "joint", name).expect(name);
            let (resistance, k) = (of_motor("resistance"), of_motor("motorconst"));
            // One volt at rest, and one radian a second without a volt.
            let torque = motor.kt_n_m_a / motor.resistance_ohm * turns;
            assert!((k / resistance / torque - 1.0).abs() < 1e-9, "{name}");
            let brake = torque * motor.kb_v_s_rad * turns;
            assert!((k * k / resistance / brake - 1.0).abs() < 1e-9, "{name}");
            let inertia = motor.inertia_kg_m2 * turns * turns;
            assert!(
                (of_joint("armature") / inertia - 1.0).abs() < 1e-9,
                "{name}"
            );
            let viscous = motor.viscous_n_m_s * turns * turns;
            assert!((of_joint("damping") / viscous - 1.0).abs() < 1e-9, "{name}");
            // The bristles' friction stands once.
            let coulomb = subject.terms[1].values[0] * torque;
            assert!(
                (of_joint("frictionloss") / coulomb - 1.0).abs() < 1e-9,
                "{name}"
            );
            assert!(of_motor("lugre") > 0.0, "{name}");
        }
    }
}
