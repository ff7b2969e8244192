//! Facts that the encoder cannot tell: from a meter, a datasheet, a current sensor, or coasting.

use serde_json::Value;
use servoid_plant::{Machine, PRESETS};

use crate::contract::{number, parameter};
use crate::desk::Desk;

/// Largest relative error of the physical parameters.
const RELATIVE: f64 = 2e-3;

/// The six parameters, their names in the fit, and their true values.
fn six(machine: &Machine) -> [(&'static str, f64); 6] {
    [
        ("resistance", machine.resistance_ohm),
        ("inductance", machine.inductance_h),
        ("kt", machine.kt_n_m_a),
        ("kb", machine.kb_v_s_rad),
        ("inertia", machine.inertia_kg_m2),
        ("viscous", machine.viscous_n_m_s),
    ]
}

fn assert_near(fit: &Value, truths: &[(&str, f64)], case: &str) {
    for (name, truth) in truths {
        let found = parameter(fit, name);
        let value = number(found, "value");
        assert!(
            (value / truth - 1.0).abs() < RELATIVE,
            "{name}: {value}, not {truth}; {case}"
        );
        assert_eq!(found["identifiable"], true, "{name}; {case}");
    }
}

fn assert_absent(fit: &Value, names: &[&str], case: &str) {
    let found = fit["parameters"].as_array().expect("a list");
    for name in names {
        assert!(
            found.iter().all(|p| p["name"] != *name),
            "{name} from nothing; {case}"
        );
    }
}

#[test]
fn with_coasting_a_resistance_and_equal_constants_all_six_follow() {
    for name in PRESETS {
        let machine = Machine::preset(name).expect("a preset");
        let desk = Desk::new();
        desk.done(&format!(
            "simulate --machine {name} --excite commissioning-coast --out rec.csv"
        ));
        let ohm = machine.resistance_ohm;

        let fit = desk.json(&format!(
            "fit rec.csv --known resistance_ohm={ohm} --kt-equals-kb"
        ));
        assert_near(&fit, &six(&machine), &format!("{name} with flags"));

        let motor = desk.read("motor.toml");
        let known = format!("[known]\nresistance_ohm = {ohm}\nkt_equals_kb = true\n");
        desk.write("motor.toml", format!("{motor}\n{known}"));
        assert_eq!(
            desk.json("fit rec.csv"),
            fit,
            "{name}: the file must say what the flags say"
        );
    }
}

#[test]
fn coasting_parts_viscous_friction_from_back_emf() {
    for name in PRESETS {
        let machine = Machine::preset(name).expect("a preset");
        let desk = Desk::new();
        desk.done(&format!(
            "simulate --machine {name} --excite commissioning-coast --out rec.csv"
        ));
        let fit = desk.json("fit rec.csv");
        let (emf, friction) = (
            machine.kt_n_m_a * machine.kb_v_s_rad,
            machine.resistance_ohm * machine.viscous_n_m_s,
        );
        let truths = [
            ("kb", machine.kb_v_s_rad),
            ("viscous_part", friction / (emf + friction)),
        ];
        assert_near(&fit, &truths, name);
        assert_absent(&fit, &["resistance", "inductance", "kt", "inertia"], name);
    }
}

#[test]
fn a_current_column_gives_the_resistance() {
    for name in PRESETS {
        let machine = Machine::preset(name).expect("a preset");
        for sensor in ["--current", "--current-noise 0.01"] {
            let case = format!("{name} {sensor}");
            let desk = Desk::new();
            desk.done(&format!(
                "simulate --machine {name} --excite commissioning-coast {sensor} --out rec.csv"
            ));
            assert!(desk.read("rec.csv").contains(",current_a,"), "{case}");
            let fit = desk.json("fit rec.csv --kt-equals-kb");
            assert_near(&fit, &six(&machine), &case);
        }
    }
}

#[test]
fn nothing_is_made_up_where_nothing_is_known() {
    let desk = Desk::new();
    desk.done("simulate --out rec.csv");
    let fit = desk.json("fit rec.csv");
    let all = ["resistance", "inductance", "kt", "kb", "inertia", "viscous"];
    assert_absent(&fit, &all, "voltage and angle alone");
    let notes = fit["notes"].to_string();
    for remedy in ["resistance_ohm", "kt_equals_kb", "coasting"] {
        assert!(notes.contains(remedy), "no word of {remedy}: {notes}");
    }
}

/// A weight on the shaft is a torque that is known without a meter: what holds it tells R/Kt.
#[test]
fn with_coasting_a_known_weight_and_equal_constants_all_six_follow() {
    let machine = Machine::preset("gearmotor").expect("a preset");
    let torque = 0.03 * machine.stall_torque_n_m();
    let desk = Desk::new();
    desk.done(&format!(
        "simulate --excite commissioning-coast --hide unbalance:torque={torque} --counts-per-rev 20000 --out rec.csv"
    ));
    let line = format!("fit rec.csv --with unbalance --known unbalance_n_m={torque}");
    assert_near(
        &desk.json(&format!("{line} --kt-equals-kb")),
        &six(&machine),
        "a weight",
    );
    assert_absent(
        &desk.json("fit rec.csv --with unbalance --kt-equals-kb"),
        &["resistance", "inertia"],
        "no weight",
    );
    let without = desk.json(&line.replace("--with unbalance", ""));
    let notes = without["notes"].as_array().expect("a list").iter();
    let told = notes.filter_map(|note| note.as_str());
    assert!(
        told.into_iter()
            .any(|note| note.contains("fit --with unbalance"))
    );
}
