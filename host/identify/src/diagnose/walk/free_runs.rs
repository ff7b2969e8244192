//! Fits by free runs, where whole runs may come down to the encoder's error: there they show more than innovations do.

use super::forms::with_other_forms;
use super::moves;
use super::node::Node;
use super::pool::Pool;
use super::settings::NEAR;
use crate::diagnose::candidate::fit::{fit_screened, fit_widening};
use crate::diagnose::candidate::observer::observe_all;
use crate::diagnose::candidate::polish::polish;
use crate::diagnose::lost_counts;
use crate::diagnose::models::{FittedModel, ScreenedModel, same};
use crate::diagnose::screening::screen;
use rayon::prelude::*;
use shared::effects::Kind;

impl Pool<'_> {
    /// Whether free runs of the best node, or of one that was polished, leave the encoder's own error only.
    pub fn is_explained(&self) -> bool {
        self.polished.iter().any(FittedModel::is_proven)
            || self
                .model(self.best())
                .is_ok_and(|model| model.free().at_floor())
    }

    /// Polishes the best node, if that was not done: before more is blamed, what is there is fitted by its free runs until they converge. Then
    /// counts that the encoder lost are looked for.
    pub fn polish_best(&mut self) {
        if self.is_explained() {
            return;
        }
        let Ok(model) = self.model(self.best()) else {
            return;
        };
        let polished = self.polish(&model).unwrap_or_else(|| model.clone());
        if let Some(found) = self.with_losses(&polished) {
            self.polished.push(found);
        }
    }

    /// A model with the counts that the encoder lost, if they are what is left. In windows a jump is forgotten with the window.
    pub fn with_losses(&self, model: &FittedModel) -> Option<FittedModel> {
        let whole = self.context.span.window_s.is_none() && !model.is_proven();
        whole
            .then(|| lost_counts::found(self.context, model))
            .flatten()
    }

    /// The model of a set, polished, with other forms of its effects' curves where they earn it.
    pub fn polish(&mut self, model: &FittedModel) -> Option<FittedModel> {
        let known = |polished: &&FittedModel| same(&polished.effects, &model.effects);
        if let Some(known) = self.polished.iter().find(known) {
            return Some(known.clone());
        }
        let widened = fit_widening(self.context, model);
        let begun = widened.unwrap_or_else(|| model.clone());
        // A run over detents may be chaotic, and right: an observer shows it, and then it is followed from stretch to stretch.
        let mut observed = [begun.clone()];
        if begun.candidate.needs_angle() && !begun.is_proven() {
            observe_all(self.context, &mut observed);
        }
        let [observed] = observed;
        let is_chaotic = !begun.is_proven() && observed.judged().at_floor();
        let start = if is_chaotic { &observed } else { &begun };
        let polished = polish(self.context, start).ok()?;
        let polished = with_other_forms(self.context, &polished).unwrap_or(polished);
        let node = Node {
            foreseen: model.predicted_rms_counts,
            ..Node::at(&polished)
        };
        self.put(vec![node]);
        self.polished.push(polished.clone());
        Some(polished)
    }

    /// Fits each effect alone by its free runs, from where it was screened, and polishes the best of them: torque noise that is estimated under the
    /// linear motor hides from innovations what is far from it, as a slow spring is.
    pub fn fit_each_alone(&mut self, done: &(dyn Fn() + Sync)) {
        let kinds: Vec<Kind> = moves::possible(self.context).collect();
        let mut models = self.fit_beside(&self.base, &kinds, done);
        // One that is larger than usual may lie in a valley of its own.
        let beyond = models.par_iter().filter_map(|model| self.beyond(model));
        let beyond: Vec<FittedModel> = beyond.collect();
        models.extend(beyond);
        self.put(models.iter().map(Node::at).collect());
        if let Some(best) = models.iter().min_by(|a, b| a.by_score(b)) {
            self.polish(best);
        }
    }

    /// Fits `kind` and its look-alikes beside `parent` by their free runs, and polishes those that come near the best: where one of them explains
    /// what is missing, innovations need not lead to where another does so, too.
    pub fn fit_alike(&mut self, parent: &FittedModel, kind: Kind, done: &(dyn Fn() + Sync)) {
        let possible = moves::possible(self.context);
        let alike = |&other: &Kind| other == kind || kind.looks_like(other);
        let kinds: Vec<Kind> = possible
            .filter(|other| !parent.effects.contains(other))
            .filter(alike)
            .collect();
        let models = self.fit_beside(parent, &kinds, done);
        self.put(models.iter().map(Node::at).collect());
        let scores = models.iter().map(|model| model.ran().score());
        let best = scores.fold(f64::INFINITY, f64::min);
        for near in models
            .iter()
            .filter(|model| model.ran().score() - best < NEAR)
        {
            self.polish(near);
        }
    }

    /// `parent` with each of `kinds`, fitted by its free runs from where it was screened.
    fn fit_beside(
        &self,
        parent: &FittedModel,
        kinds: &[Kind],
        done: &(dyn Fn() + Sync),
    ) -> Vec<FittedModel> {
        let on = |_: &&Kind| !self.context.budget.exhausted();
        let fitted = kinds.par_iter().filter(on).filter_map(|&kind| {
            let screened = screen(self.context, parent, kind)?;
            let fitted = fit_screened(self.context, &screened).ok();
            done();
            fitted
        });
        fitted.collect()
    }

    /// `model`, fitted again from where its effect is twice as large as its usual range ends; `None` where the range may not be wider.
    fn beyond(&self, model: &FittedModel) -> Option<FittedModel> {
        let structure = &model.structure;
        let effect = *model.effects.first()?;
        let amplitude = effect.parameters().iter().find(|p| p.amplitude)?;
        let name = format!("{}.{}", effect.name(), amplitude.name);
        let mut unknowns = structure.unknowns.iter();
        let place = unknowns.position(|unknown| unknown.name == name)?;
        let mut x = model.x.clone();
        x[place] = 1.0;
        let wider = structure.widened_at(&x)?;
        let mut values = structure.values(&x);
        values[place] *= 2.0;
        let x = wider.coordinates(&values);
        fit_screened(self.context, &ScreenedModel::at(wider, x)).ok()
    }
}
