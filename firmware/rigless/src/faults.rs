//! Faults of the bench, each with its start time.

use clap::Args;

/// Faults, each with the virtual time in seconds at which it begins.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Faults")]
pub struct Faults {
    /// The encoder's lines are swapped: it counts the other way.
    #[arg(long)]
    pub encoder_reversed: bool,
    /// The encoder's line B is dead: it counts to and fro.
    #[arg(long)]
    pub encoder_line_dead: bool,
    /// The encoder stops counting.
    #[arg(long, value_name = "SECONDS")]
    pub encoder_stuck_at: Option<f64>,
    /// The rotor is locked.
    #[arg(long, value_name = "SECONDS")]
    pub rotor_locked_at: Option<f64>,
    /// The current sensor reads the top of its range.
    #[arg(long, value_name = "SECONDS")]
    pub over_current_at: Option<f64>,
    /// The bridge's driver reports a fault, for a millisecond.
    #[arg(long, value_name = "SECONDS")]
    pub bridge_fault_at: Option<f64>,
    /// The supply breaks down to half, for a fifth of a second.
    #[arg(long, value_name = "SECONDS")]
    pub brown_out_at: Option<f64>,
    /// The core stands still until a reset, and all around it goes on: so looks a program that never comes back.
    #[arg(long, value_name = "SECONDS")]
    pub wedged_at: Option<f64>,
    /// What the program has on its stack is overwritten: it goes wrong, and the processor notices.
    #[arg(long, value_name = "SECONDS")]
    pub crashes_at: Option<f64>,
    /// The crystal stops.
    #[arg(long, value_name = "SECONDS")]
    pub crystal_stops_at: Option<f64>,
    /// The microcontroller's reset pin is pulled.
    #[arg(long, value_name = "SECONDS")]
    pub reset_at: Option<f64>,
}

/// How long a brown-out lasts, s.
const BROWN_OUT: f64 = 0.2;

impl Faults {
    /// The supply of `volts` as it is at `now`, s.
    pub fn supply(&self, volts: f64, now: f64) -> f64 {
        let low = begun(self.brown_out_at, now) && !begun(self.brown_out_at, now - BROWN_OUT);
        if low { 0.5 * volts } else { volts }
    }
}

/// True once a fault that begins at `at` has begun by `now`, s.
pub fn begun(at: Option<f64>, now: f64) -> bool {
    at.is_some_and(|at| now >= at)
}
