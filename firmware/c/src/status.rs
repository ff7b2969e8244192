//! How a call ended.

/// How a call ended.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ServoidStatus {
    /// It has done what it does.
    Done = 0,
    /// There is more to do: call it again.
    Running = 1,
    /// An address is null.
    Null = 2,
    /// What must be called before was not.
    TooEarly = 3,
    /// The shaft did not move with the drive: there is nothing to fit.
    NothingToFit = 4,
    /// No motor of the recording could be built: it is beyond the number format.
    NoModel = 5,
    /// A number is not finite, or beyond its range.
    OutOfRange = 6,
}

/// How a call ended that may have ended early.
pub(crate) fn told(ended: Result<(), ServoidStatus>) -> ServoidStatus {
    ended.err().unwrap_or(ServoidStatus::Done)
}
