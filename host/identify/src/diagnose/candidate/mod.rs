//! One model with given effects: searched for, scored, and brought to its end.

mod both;
mod bounded_step;
pub mod continuation;
pub mod descent;
pub mod fit;
pub mod observer;
pub mod polish;
pub mod score;
pub mod search;
mod settings;
pub mod several_horizons;
