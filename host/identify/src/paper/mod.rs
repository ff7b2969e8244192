//! "Metaheuristic algorithms for parameter estimation of DC servo motors with quantized sensor
//! measurements", IJAPE 14(1), 2025: its motor, its table, its step, and our runs of its contest.

mod contest;
mod table;

pub use contest::{
    BOX, Experiment, Quantiser, Variant, identifiable_problem, paper_problem, solvers,
};
pub use table::{PRINTED, Printed};
