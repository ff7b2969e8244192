//! Single steps of an angle that no shaft makes: where it wraps, and where its counter was set to another value.

use crate::median::median_interval;

/// A step within this part of a turn tells its direction.
const TOLD: f64 = 0.4;
/// A step that is left when the turn is added may differ from its neighbours by so many of the usual differences, and counts.
const LIKE: (f64, f64) = (4.0, 4.0);
/// Tenths of a degree in a turn.
pub(super) const DECIDEGREES: f64 = 3600.0;
/// Part of the jumps that must agree.
const AGREE: f64 = 0.9;
/// A counter was set anew where a step is so many times farther off its neighbours than any other, and by so many counts; fewer are
/// counts that an encoder lost, which the diagnosis names.
const SET: (f64, f64) = (4.0, 64.0);
/// The steps before and after it are alike to this part of it.
const ALIKE: f64 = 0.25;
/// More of them are a fault of another kind.
const MOST_SET: usize = 3;
/// Part of all steps that must lie apart from jumps to tell what is usual.
const APART: f64 = 0.2;
/// Rows are missing where readings are so many usual intervals apart.
const MISSING: f64 = 1.5;
/// Fewest readings that tell anything.
const FEWEST: usize = 30;

/// An angle that was unwrapped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wrapped {
    /// Where it wraps, counts.
    pub(super) turn: f64,
    /// How many times.
    pub(super) times: usize,
}

/// Adds the turns to an angle that wraps every revolution or every 2^k counts. One whose steps are too large to tell their direction is
/// left as it is.
pub(super) fn unwrapped(counts: &mut [f64], counts_per_rev: f64) -> Option<Wrapped> {
    let least = counts.iter().copied().fold(f64::INFINITY, f64::min);
    let most = counts.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let travel = most - least;
    let powers = (8..=32).map(|bits| 2f64.powi(bits));
    // Tenths of a degree are what many magnetic encoders and servos log.
    let turns = [counts_per_rev, DECIDEGREES].into_iter().chain(powers);
    // Angles printed with few digits may end a little outside the turn.
    let mut fitting = turns.filter(|turn| travel <= 1.001 * turn && travel > 0.6 * turn);
    let turn = fitting.find(|turn| wraps(counts, *turn))?;
    let mut times = 0;
    let mut before = *counts.first()?;
    let mut whole = 0.0;
    for count in counts.iter_mut().skip(1) {
        let step = *count - before;
        before = *count;
        if step.abs() > turn / 2.0 {
            whole -= turn * step.signum();
            times += 1;
        }
        *count += whole;
    }
    Some(Wrapped { turn, times })
}

fn wraps(counts: &[f64], turn: f64) -> bool {
    let steps: Vec<f64> = counts.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let near = |step: f64| {
        if step.abs() > turn / 2.0 {
            step - turn * step.signum()
        } else {
            step
        }
    };
    if steps.len() < FEWEST || steps.iter().any(|step| near(*step).abs() > TOLD * turn) {
        return false;
    }
    let bends: Vec<f64> = (1..steps.len() - 1)
        .map(|k| (near(steps[k]) - 0.5 * (near(steps[k - 1]) + near(steps[k + 1]))).abs())
        .collect();
    let is_jump = |k: usize| steps[k].abs() > turn / 2.0;
    // What only looks like a jump bends its neighbours as well: the steps apart from all jumps tell what is usual.
    let apart = (1..steps.len() - 1).filter(|k| !(k - 1..=k + 1).any(is_jump));
    let apart: Vec<f64> = apart.map(|k| bends[k - 1]).collect();
    let tells = apart.len() as f64 > APART * bends.len() as f64;
    let usual = usually(if tells { &apart } else { &bends });
    let (mut jumps, mut agree) = (0, 0);
    for (k, bend) in (1..).zip(&bends) {
        if is_jump(k) {
            jumps += 1;
            agree += usize::from(*bend <= LIKE.0 * usual + LIKE.1);
        }
    }
    jumps > 0 && agree as f64 >= AGREE * f64::from(jumps)
}

/// What 95 of a hundred values do not exceed; of one at least.
fn usually(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let place = values.len() * 95 / 100;
    *values.select_nth_unstable_by(place, f64::total_cmp).1
}

/// Where a counter was set to another value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SetAnew {
    /// The first reading after it.
    pub(super) at: usize,
    /// By how many counts: the step without the motion.
    pub(super) by: f64,
}

/// Where a counter was set to another value: a single step far off its neighbours, which are alike. A step over missing rows, which
/// the times show, tells nothing.
pub(super) fn set_anew(time_s: &[f64], counts: &[f64]) -> Vec<SetAnew> {
    let steps: Vec<f64> = counts.windows(2).map(|pair| pair[1] - pair[0]).collect();
    if steps.len() < FEWEST {
        return Vec::new();
    }
    let usual_s = median_interval(time_s);
    let is_near = |k: usize| time_s[k + 1] - time_s[k] < MISSING * usual_s;
    let excess = |k: usize| steps[k] - 0.5 * (steps[k - 1] + steps[k + 1]);
    let off = |k: usize| excess(k).abs();
    let inner: Vec<usize> = (1..steps.len() - 1)
        .filter(|k| (k - 1..=k + 1).all(is_near))
        .collect();
    // Beside fewer nothing is unusual.
    if inner.len() < FEWEST {
        return Vec::new();
    }
    let usual = usually(&inner.iter().map(|k| off(*k)).collect::<Vec<_>>());
    let mut farthest = inner.clone();
    let kept = (3 * MOST_SET + 1).min(farthest.len());
    farthest.select_nth_unstable_by(kept - 1, |a, b| off(*b).total_cmp(&off(*a)));
    farthest.truncate(kept);
    farthest.sort_by(|a, b| off(*b).total_cmp(&off(*a)));
    for count in (1..=MOST_SET).rev() {
        let mut found: Vec<usize> = Vec::new();
        for k in &farthest {
            let beside = found.iter().any(|other| other.abs_diff(*k) <= 1);
            if found.len() < count && !beside {
                found.push(*k);
            }
        }
        let others = inner
            .iter()
            .filter(|k| found.iter().all(|other| other.abs_diff(**k) > 1));
        let rest = others.map(|k| off(*k)).fold(0.0, f64::max);
        let is_set = |k: &usize| {
            let change = (steps[k + 1] - steps[k - 1]).abs();
            off(*k) >= (SET.0 * rest).max(SET.1)
                && change <= ALIKE * off(*k)
                // A reading that was stuck goes on at full speed.
                && change <= 2.0 * (LIKE.0 * usual + LIKE.1)
        };
        if found.len() == count && found.iter().all(is_set) {
            found.sort_unstable();
            let set = |k: usize| SetAnew {
                at: k + 1,
                by: excess(k),
            };
            return found.into_iter().map(set).collect();
        }
    }
    Vec::new()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A motor that speeds up and slows down, in whole counts.
    fn motion(fastest: f64) -> Vec<f64> {
        let mut angle = 0.0;
        let speed = |k: usize| fastest * libm::sin(0.01 * k as f64);
        (0..2000)
            .map(|k| {
                angle += speed(k);
                f64::floor(angle)
            })
            .collect()
    }

    fn found(counts: &[f64]) -> Vec<usize> {
        let times: Vec<f64> = (0..counts.len()).map(|k| 0.005 * k as f64).collect();
        set_anew(&times, counts).iter().map(|set| set.at).collect()
    }

    #[test]
    fn rows_that_are_missing_are_no_jump() {
        for missing in [700..701, 700..712] {
            let mut counts = motion(45.0);
            let mut times: Vec<f64> = (0..counts.len()).map(|k| 0.005 * k as f64).collect();
            counts.drain(missing.clone());
            times.drain(missing);
            assert_eq!(set_anew(&times, &counts), []);
        }
    }

    #[test]
    fn a_reading_that_was_stuck_is_no_jump() {
        let mut counts = motion(45.0);
        let held = counts[300];
        counts[300..500].fill(held);
        assert!(found(&counts).is_empty());
    }

    #[test]
    fn tenths_of_a_degree_wrap_whatever_the_encoder_counts() {
        let whole = motion(100.0);
        let mut wrapped: Vec<f64> = whole.iter().map(|x| x.rem_euclid(3600.0)).collect();
        let found = unwrapped(&mut wrapped, 1024.0).expect("it wraps");
        assert_eq!(found.turn, 3600.0);
        assert_eq!(wrapped[1999] - wrapped[0], whole[1999] - whole[0]);
    }

    #[test]
    fn wrapped_angles_are_unwrapped() {
        for (turn, fastest) in [
            (4096.0, 50.0),
            (4096.0, 1500.0),
            (360.0, 100.0),
            (65536.0, 300.0),
        ] {
            let whole = motion(fastest);
            let mut wrapped: Vec<f64> = whole.iter().map(|x| x.rem_euclid(turn)).collect();
            let found = unwrapped(&mut wrapped, turn).expect("it wraps");
            assert_eq!(found.turn, turn);
            let start = wrapped[0] - whole[0];
            let same = whole.iter().zip(&wrapped).all(|(a, b)| b - a == start);
            assert!(same, "{turn} {fastest}");
        }
    }

    #[test]
    fn what_does_not_wrap_is_left_alone() {
        for fastest in [1.0, 20.0, 45.0] {
            let whole = motion(fastest);
            let mut counts = whole.clone();
            assert_eq!(unwrapped(&mut counts, 4096.0), None);
            assert_eq!(counts, whole);
            assert!(found(&whole).is_empty());
        }
        // Too fast to tell.
        let mut counts: Vec<f64> = motion(2000.0)
            .iter()
            .map(|x| x.rem_euclid(4096.0))
            .collect();
        assert_eq!(unwrapped(&mut counts, 4096.0), None);
    }

    #[test]
    fn a_counter_that_is_set_anew_is_found() {
        for (at, by) in [(700, -460.0), (300, 90.0), (1500, -41_816.0)] {
            let mut counts = motion(45.0);
            counts[at..].iter_mut().for_each(|x| *x += by);
            let times: Vec<f64> = (0..counts.len()).map(|k| 0.005 * k as f64).collect();
            let [set] = set_anew(&times, &counts)[..] else {
                panic!("{by}: {:?}", found(&counts));
            };
            assert_eq!(set.at, at);
            assert!((set.by - by).abs() < 5.0, "{by}: {}", set.by);
        }
        let mut counts = motion(45.0);
        counts[500..].iter_mut().for_each(|x| *x += 300.0);
        counts[900..].iter_mut().for_each(|x| *x -= 5000.0);
        assert_eq!(found(&counts), [500, 900]);
    }
}
