//! What a format wrote: its text, where each number went, and what it has no place for.

use super::side::Side;
use super::subject::Subject;
use schemars::JsonSchema;
use serde::Serialize;
use shared::effects::Kind;

/// Where a number of the result went.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mapped {
    /// Its name in the result.
    pub from: String,
    /// Its name in the format.
    pub to: String,
    /// Its unit there.
    pub unit: String,
    /// Which shaft it speaks of: `motor` or `output`.
    pub side: &'static str,
}

/// Something that was left out.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct Lack {
    /// What: an effect, a parameter, or a part of one.
    pub what: String,
    /// Why.
    pub why: String,
}

/// How much of an effect a format carries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Carried {
    /// All of it.
    Whole,
    /// All but what is named.
    Without(&'static str),
    /// Nothing, and why.
    Not(&'static str),
}

/// What a format wrote.
#[derive(Clone, Debug, PartialEq)]
pub struct Written {
    /// The text.
    pub text: String,
    /// Where each number went.
    pub mapping: Vec<Mapped>,
    /// What has no place in the format or is not determined.
    pub cannot_carry: Vec<Lack>,
    /// What a user should know beside that.
    pub remarks: Vec<String>,
    side: &'static str,
}

impl Written {
    /// Nothing yet.
    pub fn new(subject: &Subject) -> Self {
        let mut remarks: Vec<String> = subject.grade_text().into_iter().collect();
        let once = [Kind::Unbalance, Kind::EncEcc];
        for term in &subject.terms {
            if subject.side != Side::Motor && once.contains(&term.kind) {
                let name = term.kind.name();
                remarks.push(format!("{name}: its angle theta stays the motor's"));
            }
        }
        Written {
            text: String::new(),
            mapping: Vec::new(),
            cannot_carry: Vec::new(),
            remarks,
            side: subject.side.name(),
        }
    }

    /// Notes that the number `from` of the result became `to`.
    pub fn map(&mut self, from: &str, to: &str, unit: &str) {
        self.mapping.push(Mapped {
            from: from.to_owned(),
            to: to.to_owned(),
            unit: unit.to_owned(),
            side: self.side,
        });
    }

    /// Notes what was left out.
    pub fn lacks(&mut self, what: &str, why: &str) {
        self.cannot_carry.push(Lack {
            what: what.to_owned(),
            why: why.to_owned(),
        });
    }

    /// Notes what of each effect the format does not carry.
    pub fn judge(&mut self, subject: &Subject, carries: impl Fn(Kind) -> Carried) {
        for term in &subject.terms {
            match carries(term.kind) {
                Carried::Whole => {}
                Carried::Without(part) => {
                    self.lacks(term.kind.name(), &format!("only in part: {part}"));
                }
                Carried::Not(why) => self.lacks(term.kind.name(), why),
            }
        }
    }

    /// What was left out and what to know, a line each.
    pub fn lines(&self) -> Vec<String> {
        let lacks = self.cannot_carry.iter();
        let lacks = lacks.map(|lack| format!("not carried: {}: {}", lack.what, lack.why));
        lacks.chain(self.remarks.iter().cloned()).collect()
    }
}
