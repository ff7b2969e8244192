//! Undo and redo: what lay on the bench before each change, and what an undo took away.

use super::state::State;
use crate::error::Error;
use std::sync::Arc;

/// Most changes that are remembered.
const MOST: usize = 100;

/// The states before and after the one on the bench.
#[derive(Default)]
pub(super) struct History {
    past: Vec<State>,
    future: Vec<State>,
}

impl History {
    /// Remembers what lay on the bench before a change; what was undone before it is gone.
    pub(super) fn changed(&mut self, before: State) {
        self.future.clear();
        self.past.push(before);
        if self.past.len() > MOST {
            self.past.remove(0);
        }
    }

    /// Goes back by one change.
    ///
    /// # Errors
    /// Where there is none.
    pub(super) fn undo(&mut self, now: &mut State) -> Result<(), Error> {
        let nothing = || Error::Usage("there is nothing to undo".to_owned());
        let before = self.past.pop().ok_or_else(nothing)?;
        self.future.push(laid(before, now));
        Ok(())
    }

    /// Does again what was undone last.
    ///
    /// # Errors
    /// Where nothing was.
    pub(super) fn redo(&mut self, now: &mut State) -> Result<(), Error> {
        let nothing = || Error::Usage("there is nothing to do again".to_owned());
        let after = self.future.pop().ok_or_else(nothing)?;
        self.past.push(laid(after, now));
        Ok(())
    }

    /// Whether there is something to undo, and something to do again.
    pub(super) fn has(&self) -> (bool, bool) {
        (!self.past.is_empty(), !self.future.is_empty())
    }
}

/// Lays another state on the bench and gives the one that lay there.
fn laid(mut other: State, now: &mut State) -> State {
    // A number that was given is not given again.
    other.carry_on(now);
    std::mem::replace(now, other)
}

impl State {
    /// Whether the same work lies on both; what is looked at is no work.
    pub(super) fn has_same_work(&self, other: &State) -> bool {
        let recordings = match (&self.recordings, &other.recordings) {
            (None, None) => true,
            (Some(one), Some(other)) => one.are(other),
            _ => false,
        };
        let models = self.models.len() == other.models.len()
            && (self.models.iter().zip(&other.models))
                .all(|(one, other)| one.id == other.id && Arc::ptr_eq(&one.fit, &other.fit));
        let told = |state: &State| state.secret.as_ref().map(|s| (s.seed, s.revealed));
        recordings
            && models
            && self.race == other.race
            && self.diagnosis == other.diagnosis
            && self.locked == other.locked
            && told(self) == told(other)
    }
}

#[cfg(test)]
mod tests {
    use super::super::blind::recorded;
    use super::super::model::Model;
    use super::super::recordings::{Recordings, options};
    use super::super::state::{Bench, State, Way};
    use super::MOST;
    use serde_json::{Value, json};
    use servoid_identify::{Silent, identify_data};
    use servoid_io::showcase;
    use servoid_plant::Hidden;
    use shared::effects::Kind;

    /// Actions of a walk.
    const ACTIONS: u64 = 200;

    /// Recordings of two motors, each with a fitted model.
    fn prepared() -> Vec<(Recordings, Model)> {
        let with = |name: &str| {
            let hidden = Hidden::typical(name, &showcase::machine()).expect("an effect");
            let [fitted, other] = [1, 2]
                .map(|seed| recorded(std::slice::from_ref(&hidden), seed, name).expect("recorded"));
            let recordings = Recordings::new(fitted, Some(other));
            let (data, held_out) = recordings.parts();
            let asked = options(&recordings.fitted, &[]);
            let fit =
                identify_data(data, Some(held_out), &asked, &Silent::default()).expect("a fit");
            let model = Model::new(Vec::new(), fit, None, None, &recordings).expect("a model");
            (recordings, model)
        };
        ["coulomb", "dead_zone"].map(with).into()
    }

    /// The work that lies on the bench.
    #[derive(Clone, Debug, PartialEq)]
    struct Lay {
        recordings: Option<u64>,
        models: Vec<(usize, u64)>,
        locked: Vec<&'static str>,
        race: Option<Value>,
    }

    impl Lay {
        fn of(state: &State) -> Self {
            Lay {
                recordings: state.recordings.as_ref().map(|one| one.stamp),
                models: (state.models.iter())
                    .map(|model| (model.id, model.stamp))
                    .collect(),
                locked: state.locked.iter().map(|kind| kind.name()).collect(),
                race: state.race.clone(),
            }
        }
    }

    /// Something that a user does to the bench.
    fn act(state: &mut State, prepared: &[(Recordings, Model)], random: u64) {
        let pick = (random >> 32) as usize;
        match random >> 61 {
            0 | 1 => state.race = Some(json!(random)),
            2 | 3 => {
                let kind = Kind::ALL[pick % Kind::ALL.len()];
                let had = state.locked.len();
                state.locked.retain(|other| *other != kind);
                if state.locked.len() == had {
                    state.locked.push(kind);
                }
            }
            4 => state.begin(prepared[pick % prepared.len()].0.clone()),
            5 | 6 => {
                let here = state.recordings.as_ref().map(|one| one.stamp);
                let own = (prepared.iter()).find(|(one, _)| Some(one.stamp) == here);
                if let Some((_, model)) = own {
                    let effects = vec![Kind::ALL[pick % Kind::ALL.len()]];
                    state.put(Model {
                        effects,
                        ..model.clone()
                    });
                }
            }
            _ => {
                if let Some(id) = state.models.first().map(|model| model.id) {
                    state.remove(id).expect("it is there");
                }
            }
        }
    }

    /// Random walks against a list of what lay on the bench and a place in it.
    #[test]
    fn undo_and_redo_go_along_everything_that_lay_on_the_bench() {
        let prepared = prepared();
        for seed in 0..30u64 {
            let bench = Bench::new(None, None);
            let mut lay = vec![Lay::of(&bench.state())];
            let mut here = 0;
            let mut random = seed;
            for action in 0..ACTIONS {
                random = random
                    .wrapping_mul(6364136223846793005)
                    .wrapping_add(1442695040888963407);
                match random >> 62 {
                    0 | 1 => {
                        bench.change(|state| act(state, &prepared, random << 1));
                        let now = Lay::of(&bench.state());
                        if now != lay[here] {
                            lay.truncate(here + 1);
                            lay.push(now);
                            here += 1;
                        }
                        if here > MOST {
                            lay.remove(0);
                            here -= 1;
                        }
                    }
                    2 => {
                        assert_eq!(bench.go(Way::Undo).is_ok(), here > 0, "seed {seed}");
                        here = here.saturating_sub(1);
                    }
                    _ => {
                        let more = here + 1 < lay.len();
                        assert_eq!(bench.go(Way::Redo).is_ok(), more, "seed {seed}");
                        here += usize::from(more);
                    }
                }
                let now = Lay::of(&bench.state());
                assert_eq!(now, lay[here], "seed {seed}, action {action}");
                let has = bench.history().has();
                assert_eq!(has, (here > 0, here + 1 < lay.len()), "seed {seed}");
                // Looking at something is no work.
                bench.change(|state| state.fault = Some("looked".to_owned()));
            }
        }
    }
}
