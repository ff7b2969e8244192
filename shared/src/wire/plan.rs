//! A plan in numbered parts, and the digest by which both sides mean the same one.
//!
//! A part names the plan that it belongs to and where in it, so that a part that is lost, comes twice, late or from another plan
//! cannot become a part of what is played. The device says after each part how much it holds, and a start names the digest of the
//! plan that it starts.

use super::frame::CRC;
use heapless::Vec;
use serde::{Deserialize, Serialize};

/// Most segments of a plan in one message.
pub const MOST_SEGMENTS: usize = 16;

/// Most segments of a plan that the firmware's applications hold.
pub const PLAN_SEGMENTS: usize = 256;

/// A stretch of a plan: one duty ([`OPEN`](crate::trace::OPEN) for an open bridge) for so many periods.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Segment {
    /// The duty, see [`About::full`](super::About::full).
    pub duty: i16,
    /// Periods.
    pub periods: u16,
}

/// Length and checksum of a whole plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PlanDigest {
    /// Number of its segments.
    pub segments: u16,
    /// CRC-32 of their duties and periods, two bytes each, little-endian.
    pub check: u32,
}

impl PlanDigest {
    /// The digest of a plan. One of more than 65,535 segments, which no device holds, has that of its first ones.
    pub fn of(plan: &[Segment]) -> Self {
        let segments = u16::try_from(plan.len()).unwrap_or(u16::MAX);
        let mut digest = CRC.digest();
        for segment in plan.iter().take(segments.into()) {
            digest.update(&segment.duty.to_le_bytes());
            digest.update(&segment.periods.to_le_bytes());
        }
        PlanDigest {
            segments,
            check: digest.finalize(),
        }
    }
}

/// A part of a plan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlanPart {
    /// The plan that it belongs to.
    pub of: PlanDigest,
    /// Index of its first segment.
    pub first: u16,
    /// Its segments.
    pub segments: Vec<Segment, MOST_SEGMENTS>,
}

/// A plan that is put together of its parts, at most `N` segments.
#[derive(Clone, Debug)]
pub struct PlanStore<const N: usize> {
    of: PlanDigest,
    segments: Vec<Segment, N>,
}

impl<const N: usize> Default for PlanStore<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> PlanStore<N> {
    /// Empty.
    pub const fn new() -> Self {
        PlanStore {
            of: PlanDigest {
                segments: 0,
                check: 0,
            },
            segments: Vec::new(),
        }
    }

    /// Takes what a part brings on, and gives the number of segments held: a part that leaves a gap brings nothing, one of another
    /// plan begins that one anew. Nothing if the plan has no room here, or the part is none of it.
    pub fn take(&mut self, part: &PlanPart) -> Option<u16> {
        let (whole, first) = (usize::from(part.of.segments), usize::from(part.first));
        if whole > N || first + part.segments.len() > whole {
            return None;
        }
        if self.of != part.of {
            self.of = part.of;
            self.segments.clear();
        }
        if let Some(known) = self.segments.len().checked_sub(first) {
            let news = part.segments.get(known..).unwrap_or(&[]);
            self.segments.extend_from_slice(news).ok()?;
        }
        u16::try_from(self.segments.len()).ok()
    }

    /// The plan, if it is whole and the one with this digest.
    pub fn whole(&self, of: PlanDigest) -> Option<&[Segment]> {
        (!self.segments.is_empty() && PlanDigest::of(&self.segments) == of)
            .then_some(self.segments.as_slice())
    }

    /// Its segments so far.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }
}
