//! The numbers of this stage that decide.

// budget

/// Steps of a model that a diagnosis may take where nobody says otherwise: ten times what 20 s at 1 kHz usually take,
/// and between one and two minutes of one processor core of 2024.
pub const USUAL_STEPS: u64 = 600_000_000;
/// Part of the steps within which effects are searched for. The rest is for trying what was found against its
/// look-alikes, without which no name is worth much.
pub const SEARCH: f64 = 0.75;

// context

/// Most samples of a recording that a search runs over.
pub const MOST_SAMPLES: usize = 25_000;
/// The golden section: its multiples fall in no step with anything that repeats in a recording.
pub const GOLDEN: f64 = 0.618_033_988_749_895;

// motion

/// Counts that the fastest motion passes within half a window of the speed's estimate, roughly: enough
/// that the encoder's steps are one part in a hundred.
pub const WINDOW_COUNTS: f64 = 60.0;

// span

/// Length of the windows when the user chose none, s.
pub const USUAL_WINDOW_S: f64 = 0.5;
/// Fewest samples of such a window.
pub const FEWEST_SAMPLES: f64 = 50.0;
/// A motor that strays by this part of the motion's spread was not moved by its voltage and a constant alone.
pub const LOST: f64 = 0.8;
/// Part of the travel that must go against the prevailing direction.
pub const AGAINST: f64 = 0.05;
