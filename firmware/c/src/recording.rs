//! A recording in the caller's memory.

use shared::trace::Trace;

/// The duty that stands for an open bridge.
pub const SERVOID_OPEN: i16 = -32768;
const _: () = assert!(SERVOID_OPEN == shared::trace::OPEN);

/// A run from standstill: `duties[k]` is held from one reading of the encoder to the next, which is `steps[k]` counts further.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct ServoidRecording {
    /// Duties: 32,768 is the whole supply, `SERVOID_OPEN` an open bridge.
    pub duties: *const i16,
    /// Counts travelled in each period.
    pub steps: *const i16,
    /// Periods, of which both arrays have as many.
    pub periods: u32,
}

impl ServoidRecording {
    /// The recording, unless an array is null.
    ///
    /// # Safety
    /// Both arrays have as many elements as there are periods, and nothing writes to them meanwhile.
    pub(crate) unsafe fn trace<'a>(&self) -> Option<Trace<'a>> {
        if self.duties.is_null() || self.steps.is_null() {
            return None;
        }
        let periods = self.periods as usize;
        // SAFETY: neither is null, and the caller answers for their length.
        let (duties, steps) = unsafe {
            (
                core::slice::from_raw_parts(self.duties, periods),
                core::slice::from_raw_parts(self.steps, periods),
            )
        };
        Some(Trace::new(duties, steps))
    }
}
