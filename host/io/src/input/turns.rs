//! Rows of several motors that take turns in one table, told by a column whose values do.

use super::profile::Profile;

/// Motors whose rows may take turns.
const MOST_MOTORS: usize = 16;
/// Part of the rows that must follow the turn.
const IN_TURN: f64 = 0.9;
/// Rows that tell anything.
const FEWEST: usize = 40;
/// What an angle moves within the rows of one motor is so small a part of what it moves over all rows.
const WITHIN: f64 = 0.2;

/// Motors that take turns.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Turns {
    /// The column that tells them apart.
    pub(super) column: String,
    /// Its values, the least first.
    pub(super) values: Vec<String>,
}

/// The motors among columns with names, where their rows take turns and the column of the angle jumps between them, or another column
/// says by its name whose row it is.
pub(super) fn several(columns: &[(String, Profile)], angle: usize) -> Option<Turns> {
    let (_, angle_of) = columns.get(angle)?;
    let others = columns.iter().enumerate().filter(|(k, _)| *k != angle);
    others.into_iter().find_map(|(_, (name, profile))| {
        let levels = takes_turns(profile)?;
        if !(is_identity(name) || parts(&angle_of.first, &profile.first)) {
            return None;
        }
        let value = |level: &f64| match profile.words.get(*level as usize) {
            Some(word) if profile.numbers == 0 => word.clone(),
            _ => level.to_string(),
        };
        Some(Turns {
            column: name.clone(),
            values: levels.iter().map(value).collect(),
        })
    })
}

/// The values of a column that take turns: each comes again after as many rows as there are values.
fn takes_turns(profile: &Profile) -> Option<Vec<f64>> {
    let levels = profile.levels(MOST_MOTORS)?;
    let (count, rows) = (levels.len(), profile.first.len());
    if count < 2 || rows < FEWEST || levels.iter().any(|level| level.fract() != 0.0) {
        return None;
    }
    let first = &profile.first;
    let periodic = (count..rows)
        .filter(|k| first[*k] == first[*k - count])
        .count();
    let changing = (1..rows).filter(|k| first[*k] != first[*k - 1]).count();
    let enough = |found: usize, of: usize| found as f64 >= IN_TURN * of as f64;
    (enough(periodic, rows - count) && enough(changing, rows - 1)).then_some(levels)
}

/// Whether a name says whose row it is.
fn is_identity(name: &str) -> bool {
    let words = [
        "id", "motor", "axis", "joint", "node", "can", "device", "servo", "achse", "axe",
    ];
    let mut parts = name
        .split(|c: char| !c.is_alphanumeric())
        .map(str::to_lowercase);
    parts.any(|part| words.contains(&part.as_str()) || part.ends_with("id"))
}

/// Whether an angle is smooth within the rows of one value, and jumps between them.
fn parts(angle: &[f64], by: &[f64]) -> bool {
    let moved = |a: f64, b: f64| Some((a - b).abs()).filter(|step| step.is_finite());
    let over: f64 = angle
        .windows(2)
        .filter_map(|pair| moved(pair[1], pair[0]))
        .sum();
    let mut last: Vec<(f64, f64)> = Vec::new();
    let mut within = 0.0;
    for (value, key) in angle.iter().zip(by) {
        match last.iter_mut().find(|(own, _)| own == key) {
            Some((_, before)) => {
                within += moved(*value, *before).unwrap_or(0.0);
                *before = *value;
            }
            None => last.push((*key, *value)),
        }
    }
    over > 0.0 && within < WITHIN * over
}

#[cfg(test)]
mod tests {
    use super::*;

    fn columns(
        ids: &str,
        id: impl Fn(u32) -> f64,
        angle: impl Fn(u32) -> f64,
    ) -> Vec<(String, Profile)> {
        let (mut by, mut of) = (Profile::default(), Profile::default());
        for k in 0..200 {
            by.take(id(k));
            of.take(angle(k));
        }
        vec![(ids.to_owned(), by), ("angle".to_owned(), of)]
    }

    #[test]
    fn motors_that_take_turns_are_told() {
        let two = columns("motor_id", |k| f64::from(1 + k % 2), |k| f64::from(k / 2));
        let found = several(&two, 1).expect("two motors");
        assert_eq!(
            (found.column.as_str(), found.values),
            ("motor_id", vec!["1".to_owned(), "2".to_owned()])
        );
        // Without such a name the angle must jump.
        let jumps = |k: u32| f64::from(k / 3) + 1000.0 * f64::from(k % 3);
        assert!(several(&columns("x", |k| f64::from(k % 3), jumps), 1).is_some());
        assert!(several(&columns("x", |k| f64::from(k % 3), f64::from), 1).is_none());
        assert!(several(&columns("motor_id", |k| f64::from(k / 100), f64::from), 1).is_none());
        assert!(several(&columns("motor_id", |_| 1.0, f64::from), 1).is_none());
    }
}
