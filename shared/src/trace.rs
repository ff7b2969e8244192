//! A recording as a device keeps it: one duty and one difference of counts a period, four bytes in all.

/// The duty that stands for an open bridge. Drives stop one short of it.
pub const OPEN: i16 = i16::MIN;

/// Voltage of a duty of one, per unit. The unit of voltage is a duty of 32,768: the whole supply, or more if the board says
/// that a smaller duty is the whole supply.
pub const DUTY: f64 = 1.0 / 32_768.0;

/// A run from standstill: `duties[k]` is held from one reading to the next, which is `steps[k]` counts further.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Trace<'a> {
    /// Duties in Q15 of the unit of voltage, or [`OPEN`].
    pub duties: &'a [i16],
    /// Counts travelled in each period.
    pub steps: &'a [i16],
    /// Periods from the start in which the bridge is closed throughout; a smaller number is no error, but costs time.
    pub closed: usize,
}

impl<'a> Trace<'a> {
    /// Of duties and steps.
    pub fn new(duties: &'a [i16], steps: &'a [i16]) -> Self {
        let first_open = duties.iter().position(|&duty| duty == OPEN);
        Trace {
            duties,
            steps,
            closed: first_open.unwrap_or(duties.len()),
        }
    }

    /// Periods that have a duty and a step.
    pub fn len(&self) -> usize {
        self.duties.len().min(self.steps.len())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Each period's duty (none while the bridge is open) and step.
    pub fn iter(&self) -> impl Iterator<Item = (Option<i16>, i16)> {
        let rows = self.duties.iter().zip(self.steps);
        rows.map(|(&duty, &step)| ((duty != OPEN).then_some(duty), step))
    }
}
