//! The experiment that decides between effects which explain the recordings about equally.

use super::device::Device;
use super::proposals;
use super::recordings::Recordings;
use super::series::picked;
use super::state::State;
use crate::error::Error;
use serde_json::{Value, json};
use servoid_engine::problem::Candidate;
use servoid_engine::simulation::Method;
use servoid_identify::plan::{
    Hypothesis, Limits, PlanTask, SEPARABLE_COUNTS, Setup, Usage, play, rank, remedy, why,
};
use servoid_io::output::CommandSequence;
use shared::effects::Kind;
use shared::encoder::FLOOR_OFFSET_COUNTS;
use shared::wire::PLAN_SEGMENTS;
use std::ops::ControlFlow;
use std::sync::atomic::AtomicBool;

/// Most effects between which an experiment decides.
const MOST: usize = 3;
/// Most points that are drawn.
const DRAWN: usize = 400;

/// A model that may be the truth.
#[derive(Clone)]
pub(super) struct Rival {
    /// The effect by which it differs from the others.
    pub(super) effect: Kind,
    /// All of its effects.
    pub(super) effects: Vec<Kind>,
    /// The model.
    pub(super) candidate: Candidate,
    /// How it is run.
    pub(super) method: Method,
    /// Its angle along the experiment, counts, one a command.
    pub(super) counts: Vec<f64>,
}

/// An experiment, and what each rival foresees of it.
pub(super) struct Planned {
    /// What is driven.
    pub(super) commands: CommandSequence,
    /// The rivals.
    pub(super) rivals: Vec<Rival>,
    excitation: String,
    reason: String,
    usage: Usage,
    least_counts: f64,
    counts_per_rev: f64,
    supply_v: f64,
}

/// The rivals beside the chosen model: effects that explain about as much as the best.
///
/// # Errors
/// Fewer than two, in words.
pub(super) fn rivals(state: &State) -> Result<Vec<Rival>, Error> {
    let chosen = state.chosen_model()?.id;
    let near = proposals::rivals(state, chosen);
    let rivals: Vec<Rival> = near
        .into_iter()
        .take(MOST)
        .map(|suggestion| Rival {
            effect: suggestion.effect,
            effects: suggestion.model.effects.clone(),
            candidate: suggestion.model.candidate,
            method: suggestion.model.method,
            counts: Vec::new(),
        })
        .collect();
    if rivals.len() < 2 {
        return Err(Error::Usage(
            "there is nothing to decide: no two effects explain these recordings about equally; record another run, \
             which judges the model"
                .to_owned(),
        ));
    }
    Ok(rivals)
}

/// Looks for the experiment of so many seconds that separates the rivals most, within the limits of the device.
///
/// # Errors
/// No experiment within the limits; effects that none separates, with the remedy.
pub(super) fn plan(
    device: &Device,
    recordings: &Recordings,
    rivals: Vec<Rival>,
    seconds: f64,
    stop: &AtomicBool,
    done: &(dyn Fn() + Sync),
) -> Result<Planned, Error> {
    let order = device.order();
    let data = recordings.shown();
    let gain = rivals[0].candidate.machine.response().gain;
    let setup = Setup {
        supply_v: order.supply_v,
        no_load_rad_s: gain.abs() * order.supply_v,
        counts_per_rev: data.units.counts_per_rev,
        sample_s: device.period_s(),
    };
    let resistance = order.resistance_ohm;
    let limits = Limits {
        voltage_v: Some(order.largest_voltage()),
        current_v: order.max_current.zip(resistance).map(|(a, ohm)| a * ohm),
        // The device counts from where the shaft stands, the plan from end to end.
        travel_rev: order.max_travel,
        commands: Some(PLAN_SEGMENTS),
    };
    let hypotheses: Vec<Hypothesis> = (rivals.iter())
        .map(|rival| Hypothesis::of(&rival.candidate))
        .collect();
    let seed = order.seed;
    let task = PlanTask {
        hypotheses: &hypotheses,
        setup,
        limits,
        seconds,
        seed,
        stop,
        done,
    };
    let ranked = rank(&task)?;
    let best = &ranked[0];
    if best.least() < SEPARABLE_COUNTS {
        return Err(Error::Failed(format!(
            "no drive within these limits separates {} from {}; what would: {}",
            hypotheses[0].name(),
            hypotheses[1].name(),
            remedy(&hypotheses[0], &hypotheses[1])
        )));
    }
    let drive = best.excitation.drive(setup.sample_s, seed);
    let mut rivals = rivals;
    for (rival, hypothesis) in rivals.iter_mut().zip(&hypotheses) {
        play(hypothesis, &setup, &drive, FLOOR_OFFSET_COUNTS, |moment| {
            rival.counts.push(moment.angle_counts);
            ControlFlow::Continue(())
        })?;
    }
    Ok(Planned {
        commands: best.excitation.commands(&setup, seed),
        excitation: best.excitation.to_string(),
        reason: why(&best.excitation, &hypotheses),
        usage: best.usage,
        least_counts: best.least(),
        counts_per_rev: setup.counts_per_rev,
        supply_v: setup.supply_v,
        rivals,
    })
}

impl Planned {
    /// What the page shows of it.
    pub(super) fn view(&self) -> Value {
        let drawn = |values: &[f64], scale: f64| -> Vec<f64> {
            picked(values, 0..values.len(), DRAWN, |x| x * scale)
        };
        let turns = 1.0 / self.counts_per_rev;
        json!({
            "excitation": self.excitation,
            "reason": self.reason,
            "seconds": self.commands.time_s.last(),
            "missed_counts": self.least_counts,
            "voltage_v": self.usage.voltage_v,
            "current_of_stall": self.usage.current_v / self.supply_v,
            "travel_rev": self.usage.travel_rev,
            "speed_rad_s": self.usage.speed_rad_s,
            "time": drawn(&self.commands.time_s, 1.0),
            "drive": drawn(&self.commands.voltage_v, 1.0),
            "rivals": self.rivals.iter().map(|rival| json!({
                "effect": rival.effect.name(), "angle": drawn(&rival.counts, turns),
            })).collect::<Vec<_>>(),
        })
    }
}
