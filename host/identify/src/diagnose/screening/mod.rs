//! A model with one effect more, fitted roughly: led along the measured motion where that is possible. It
//! foresees what the effect can explain, and is where the full fit starts.

mod common_parameters;
mod series_parallel;
mod starts;

pub use common_parameters::{Found, carried};

use crate::diagnose::candidate::descent::{PROBE, Settings};
use crate::diagnose::candidate::fit::LOST;
use crate::diagnose::candidate::search::{fit_problem, search};
use crate::diagnose::context::Workshop;
use crate::diagnose::models::{NOISE_COUNTS, Refit, Sketch};
use crate::diagnose::spectrum::spectrum;
use crate::fit::base_for;
use series_parallel::{Led, follows};
use servoid_engine::problem::Structure;
use servoid_engine::problem::unknowns::Scale;
use servoid_engine::solve::Objective;
use shared::effects::{Kind, MAX_EFFECTS};
use shared::units::Quantity;
use starts::starts;

/// Most orders of a cogging torque in a model.
const MOST_ORDERS: usize = 5;
const SKETCH: Settings = Settings {
    evaluations: 40,
    tolerance: 5e-3,
    stride: 4,
    enough: f64::INFINITY,
    damping: 1e-4,
    secant: true,
    probe: PROBE,
    probed: None,
    again: true,
};

/// Starts that are left after a glance at all of them.
const GLANCED: usize = 2;
/// An effect that cannot be led, and leaves more than this part of the error from its first start, gets no other.
const PROMISING: f64 = 0.9;

/// The model `parent` with `kind` added.
///
/// `dry` are sketches of dry friction, from which bristles start.
pub fn screen(
    workshop: &Workshop<'_>,
    parent: &Refit,
    kind: Kind,
    dry: &[Sketch],
) -> Option<Sketch> {
    let mut effects = parent.structure.effects.clone();
    let starts = match cogging_orders(workshop, parent, kind) {
        Some(orders) => vec![orders],
        None => starts(workshop, parent, kind, dry),
    };
    let own = kind.description().parameters.len();
    let times = starts.first()?.len().div_ceil(own);
    effects.extend(std::iter::repeat_n(kind, times));
    let structure = structure_near(workshop, &effects, parent);
    let mut begun: Vec<Sketch> = starts
        .into_iter()
        .map(|start| {
            let mut parameters = parent.parameters.clone();
            parameters.extend(start);
            Sketch::standing(structure.clone(), &parent.candidate, &parameters)
        })
        .collect();
    // Where every fit is a simulation, a glance at each start shows which of them is worth one.
    if !follows(kind) && begun.len() > 1 {
        for sketch in &mut begun {
            sketch.simulated = free_run_error(workshop, sketch, f64::INFINITY);
        }
        begun.sort_by(|a, b| a.simulated.total_cmp(&b.simulated));
        begun.truncate(GLANCED);
    }
    let mut best: Option<Sketch> = None;
    for start in begun {
        let Some(sketch) = screen_from(workshop, &structure, start.x) else {
            continue;
        };
        if best
            .as_ref()
            .is_none_or(|b| sketch.foreseen() < b.foreseen())
        {
            best = Some(sketch);
        }
        // Further starts are for effects that promise something from the first one, or that do nothing there.
        let leaves = best.as_ref().map_or(1.0, Sketch::foreseen) / parent.rms_counts;
        if !follows(kind) && leaves > PROMISING {
            break;
        }
    }
    best
}

/// What a count of a led error is worth in a free run of `parent` (see [`Sketch::worth`]). Near standstill the led
/// model errs by more than the free run, whatever is added to it.
pub fn free_run_ratio(workshop: &Workshop<'_>, parent: &Refit) -> f64 {
    // In windows both are set back to the measured state.
    if workshop.span.window_s.is_some() {
        return 1.0;
    }
    let alone = screen_from(workshop, &parent.structure, parent.x.clone());
    let led = alone.map_or(f64::INFINITY, |sketch| sketch.led);
    if !led.is_finite() {
        return 1.0;
    }
    (parent.ran().fitted / led.max(NOISE_COUNTS)).min(1.0)
}

/// A sketch once more, from where `there` stands and with what it has found.
pub fn rescreen(
    workshop: &Workshop<'_>,
    sketch: &Sketch,
    parent: &Refit,
    there: &Sketch,
) -> Option<Sketch> {
    let (own, theirs) = (sketch.values(), there.values());
    let own = Found {
        effects: &sketch.structure.effects,
        values: &own,
    };
    let theirs = Found {
        effects: &there.structure.effects,
        values: &theirs,
    };
    let structure = structure_near(workshop, own.effects, parent);
    let start = Sketch::standing(structure, &parent.candidate, &carried(own, theirs));
    screen_from(workshop, &start.structure, start.x)
}

/// A model that has lost effects, or has others in their place, where it stands.
pub fn restart(workshop: &Workshop<'_>, rest: &Refit) -> Sketch {
    let structure = structure_near(workshop, &rest.structure.effects, rest);
    Sketch::standing(structure, &rest.candidate, &rest.parameters)
}

/// The unknowns of a model with `effects` and a machine near that of `there`.
fn structure_near(workshop: &Workshop<'_>, effects: &[Kind], there: &Refit) -> Structure {
    let mut structure = Structure::around(
        workshop.data,
        base_for(workshop.data, effects),
        effects,
        &there.candidate.machine,
        there.structure.start_speed,
    );
    if workshop.span.window_s.is_some() {
        widen(&mut structure, workshop.data.supply);
    }
    structure
}

/// Parameters of a cogging torque of several orders: in windows, far above the reading's floor, its
/// strongest order alone may leave more than it explains.
fn cogging_orders(workshop: &Workshop<'_>, parent: &Refit, kind: Kind) -> Option<Vec<f64>> {
    if kind != Kind::Cogging || workshop.span.window_s.is_none() {
        return None;
    }
    let room = MAX_EFFECTS - parent.structure.effects.len();
    let lines = spectrum(workshop.data, &parent.candidate).lines;
    let values = lines
        .iter()
        .filter(|line| line.order > 1)
        .take(room.min(MOST_ORDERS))
        .flat_map(|line| [line.cosine, line.sine, line.order as f64]);
    Some(values.collect()).filter(|values: &Vec<f64>| !values.is_empty())
}

/// The same model, fitted roughly from `x`.
pub fn screen_from(workshop: &Workshop<'_>, structure: &Structure, x: Vec<f64>) -> Option<Sketch> {
    let samples = workshop.data.len() as f64;
    if !structure.effects.iter().all(|&kind| follows(kind)) {
        let found = search(
            workshop,
            &fit_problem(workshop, structure, workshop.method),
            &x,
            SKETCH,
            workshop.method,
        )?;
        return Some(Sketch {
            structure: structure.clone(),
            x: found.x,
            led: f64::INFINITY,
            worth: 1.0,
            simulated: (found.squares / samples).sqrt(),
        });
    }
    let led = Led {
        data: workshop.data,
        motion: &workshop.motion,
        horizon: &workshop.fitted_horizon,
        structure: structure.clone(),
        method: workshop.method,
    };
    let found = search(workshop, &led, &x, SKETCH, workshop.method)?;
    let mut sketch = Sketch::at(structure.clone(), found.x);
    sketch.led = (found.squares / samples).sqrt();
    sketch.simulated = free_run_error(workshop, &sketch, LOST * sketch.led.max(NOISE_COUNTS));
    Some(sketch)
}

/// RMS error of a free run from where a sketch stands, counts; infinite where it is above `limit`.
pub fn free_run_error(workshop: &Workshop<'_>, sketch: &Sketch, limit: f64) -> f64 {
    let samples = workshop.data.len() as f64;
    let most = limit * limit * samples;
    fit_problem(workshop, &sketch.structure, workshop.method)
        .residuals_within(&sketch.x, most)
        .filter(|(_, squares)| *squares <= most)
        .map_or(f64::INFINITY, |(_, squares)| (squares / samples).sqrt())
}

/// A motor under a controller may carry whatever it can hold: torques and voltages are searched for up to the
/// supply.
fn widen(structure: &mut Structure, supply: f64) {
    let volts = Quantity::Torque.unit();
    for unknown in &mut structure.unknowns {
        let (low, high) = unknown.range;
        if unknown.unit == volts && unknown.scale == Scale::Linear {
            unknown.range = (
                if low < 0.0 { low.min(-supply) } else { low },
                high.max(supply),
            );
        }
    }
}
