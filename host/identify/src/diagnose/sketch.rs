//! A model with one effect more, fitted roughly: led along the measured motion where that is possible. It
//! foresees what the effect can explain, and is where the full fit starts.

use super::NOISE_COUNTS;
use super::carried::{Found, carried};
use super::descent::{PROBE, Settings};
use super::led::{Led, follows};
use super::refit::{LOST, Refit};
use super::spectrum::spectrum;
use super::starts::starts;
use super::workshop::Workshop;
use crate::fit::base_for;
use servoid_engine::problem::Scale;
use servoid_engine::problem::{Candidate, Structure};
use servoid_engine::solve::Objective;
use shared::effects::{Kind, MAX_EFFECTS, Starts};
use shared::units::Quantity;

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

/// A sketch that leaves more than this factor of what another model leaves does not rival it.
const FAR: f64 = 4.0;

/// A model that was fitted roughly.
pub struct Sketch {
    /// The unknowns, with the newest effect last.
    pub structure: Structure,
    /// Where the fit ended.
    pub x: Vec<f64>,
    /// RMS error that the led model leaves, counts; infinite where the effect cannot be led.
    pub led: f64,
    /// What a count of that error is worth in a free run: what the model without the effect leaves there, over what it
    /// leaves when it is led, at most one.
    pub worth: f64,
    /// RMS error of a free run from there, counts; infinite where it is so far above the led one that the run has lost its way.
    pub simulated: f64,
}

impl Sketch {
    /// A model that is not fitted roughly, but stands where a full fit may start: at the machine and the start
    /// of `there`, with these parameters of its effects.
    pub fn standing(structure: Structure, there: &Candidate, parameters: &[f64]) -> Self {
        let values = structure.values_of(&there.machine, parameters, there.start_speed);
        let x = structure.coordinates(&values);
        Sketch::at(structure, x)
    }

    /// The same at a point of the unknowns' unit cube.
    fn at(structure: Structure, x: Vec<f64>) -> Self {
        Sketch {
            structure,
            x,
            led: f64::INFINITY,
            worth: 1.0,
            simulated: f64::INFINITY,
        }
    }

    /// Values of the effects' parameters.
    fn values(&self) -> Vec<f64> {
        let values = self.structure.values(&self.x);
        self.structure.effect_values(&values).to_vec()
    }

    /// The effect that was added.
    pub fn newest(&self) -> Option<Kind> {
        self.structure.effects.last().copied()
    }

    /// Whether a full fit may come near what `chosen` leaves, which may have been foreseen as badly.
    pub fn rivals(&self, chosen: &Refit) -> bool {
        let left = chosen.ran().fitted.max(chosen.foreseen_rms_counts);
        self.foreseen() < FAR * left.max(NOISE_COUNTS)
    }

    /// RMS error that a full fit is expected to reach, counts.
    pub fn foreseen(&self) -> f64 {
        (self.led * self.worth).min(self.simulated)
    }
}

impl Workshop<'_> {
    /// The model `parent` with `kind` added.
    ///
    /// `dry` are sketches of dry friction, from which bristles start.
    pub fn sketch(&self, parent: &Refit, kind: Kind, dry: &[Sketch]) -> Option<Sketch> {
        let mut effects = parent.structure.effects.clone();
        let starts = match self.orders(parent, kind) {
            Some(orders) => vec![orders],
            None => starts(self, parent, kind, dry),
        };
        let own = kind.description().parameters.len();
        let times = starts.first()?.len().div_ceil(own);
        effects.extend(std::iter::repeat_n(kind, times));
        let structure = self.structure(&effects, parent);
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
                sketch.simulated = self.leaves(sketch, f64::INFINITY);
            }
            begun.sort_by(|a, b| a.simulated.total_cmp(&b.simulated));
            begun.truncate(GLANCED);
        }
        let mut best: Option<Sketch> = None;
        for start in begun {
            let Some(sketch) = self.sketch_from(&structure, start.x) else {
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
    pub fn led_worth(&self, parent: &Refit) -> f64 {
        // In windows both are set back to the measured state.
        if self.span.window_s.is_some() {
            return 1.0;
        }
        let alone = self.sketch_from(&parent.structure, parent.x.clone());
        let led = alone.map_or(f64::INFINITY, |sketch| sketch.led);
        if !led.is_finite() {
            return 1.0;
        }
        (parent.ran().fitted / led.max(NOISE_COUNTS)).min(1.0)
    }

    /// A sketch once more, from where `there` stands and with what it has found.
    pub(super) fn sketch_again(
        &self,
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
        let structure = self.structure(own.effects, parent);
        let start = Sketch::standing(structure, &parent.candidate, &carried(own, theirs));
        self.sketch_from(&start.structure, start.x)
    }

    /// A model that has lost effects, or has others in their place, where it stands.
    pub(super) fn restarted(&self, rest: &Refit) -> Sketch {
        let structure = self.structure(&rest.structure.effects, rest);
        Sketch::standing(structure, &rest.candidate, &rest.parameters)
    }

    /// The unknowns of a model with `effects` and a machine near that of `there`.
    fn structure(&self, effects: &[Kind], there: &Refit) -> Structure {
        let mut structure = Structure::around(
            self.data,
            base_for(self.data, effects),
            effects,
            &there.candidate.machine,
            there.structure.start_speed,
        );
        if self.span.window_s.is_some() {
            widen(&mut structure, self.data.supply);
        }
        structure
    }

    /// Parameters of a cogging torque of several orders: in windows, far above the reading's floor, its
    /// strongest order alone may leave more than it explains.
    fn orders(&self, parent: &Refit, kind: Kind) -> Option<Vec<f64>> {
        if kind.facts().starts != Starts::AngleOrders || self.span.window_s.is_none() {
            return None;
        }
        let room = MAX_EFFECTS - parent.structure.effects.len();
        let lines = spectrum(self.data, &parent.candidate).lines;
        let values = lines
            .iter()
            .filter(|line| line.order > 1)
            .take(room.min(MOST_ORDERS))
            .flat_map(|line| [line.cosine, line.sine, line.order as f64]);
        Some(values.collect()).filter(|values: &Vec<f64>| !values.is_empty())
    }

    /// The same model, fitted roughly from `x`.
    pub(super) fn sketch_from(&self, structure: &Structure, x: Vec<f64>) -> Option<Sketch> {
        let samples = self.data.len() as f64;
        if !structure.effects.iter().all(|&kind| follows(kind)) {
            let found = self.descended(
                &self.problem(structure, self.method),
                &x,
                SKETCH,
                self.method,
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
            data: self.data,
            motion: &self.motion,
            horizon: &self.fitted_horizon,
            structure: structure.clone(),
            method: self.method,
        };
        let found = self.descended(&led, &x, SKETCH, self.method)?;
        let mut sketch = Sketch::at(structure.clone(), found.x);
        sketch.led = (found.squares / samples).sqrt();
        sketch.simulated = self.leaves(&sketch, LOST * sketch.led.max(NOISE_COUNTS));
        Some(sketch)
    }

    /// RMS error of a free run from where a sketch stands, counts; infinite where it is above `limit`.
    pub(super) fn leaves(&self, sketch: &Sketch, limit: f64) -> f64 {
        let samples = self.data.len() as f64;
        let most = limit * limit * samples;
        self.problem(&sketch.structure, self.method)
            .residuals_within(&sketch.x, most)
            .filter(|(_, squares)| *squares <= most)
            .map_or(f64::INFINITY, |(_, squares)| (squares / samples).sqrt())
    }
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
