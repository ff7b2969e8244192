//! `servoid simulate --list`: what the bench has to choose from.

use serde::Serialize;
use servoid_plant::{Machine, PRESETS};
use shared::excite::Shape;

/// Everything that can be ordered: `--list`.
#[derive(Serialize)]
pub(super) struct Offer {
    schema: &'static str,
    machines: Vec<OfferedMachine>,
    effects: Vec<&'static str>,
    excitations: Vec<OfferedExcitation>,
}

#[derive(Serialize)]
struct OfferedMachine {
    name: &'static str,
    supply_v: f64,
    no_load_rad_s: f64,
}

#[derive(Serialize)]
struct OfferedExcitation {
    name: &'static str,
    about: String,
}

impl Offer {
    pub(super) fn new() -> Self {
        let machines = PRESETS.iter().filter_map(|name| {
            let machine = Machine::preset(name).ok()?;
            Some(OfferedMachine {
                name,
                supply_v: machine.supply_v,
                no_load_rad_s: machine.top_speed_rad_s(),
            })
        });
        let programs = [
            ("commissioning", "all that tells effects apart, 20 s"),
            (
                "commissioning-coast",
                "the same, with the bridge open in the pauses",
            ),
        ]
        .map(|(name, about)| (name, about.to_owned()));
        let shapes = Shape::ALL
            .iter()
            .map(|(name, shape)| (*name, format!("shows {}", shape.reveals())));
        Offer {
            schema: "servoid.simulate-list/1",
            machines: machines.collect(),
            effects: servoid_plant::effects::CATALOGUE
                .iter()
                .map(|kind| kind.name)
                .collect(),
            excitations: programs
                .into_iter()
                .chain(shapes)
                .map(|(name, about)| OfferedExcitation { name, about })
                .collect(),
        }
    }

    /// As text for a terminal.
    pub(super) fn text(&self) -> String {
        let mut text = String::from("motors:\n");
        for OfferedMachine {
            name,
            supply_v,
            no_load_rad_s,
        } in &self.machines
        {
            text += &format!("  {name:14} {supply_v} V, no-load {no_load_rad_s:.0} rad/s\n");
        }
        text += "effects to hide:\n";
        for name in &self.effects {
            text += &format!("  {name}\n");
        }
        text += "excitations:\n";
        for OfferedExcitation { name, about } in &self.excitations {
            text += &format!("  {name:14} {about}\n");
        }
        text
    }
}
