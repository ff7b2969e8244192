//! One result, one writer a format.

mod certificate;
pub mod check;
pub mod demo;
pub mod diagnosis;
pub mod effects;
pub mod fold;
pub mod html;
mod likelihood;
pub mod opened;
pub mod paper;
pub mod plan;
mod position_loop;
mod profile;
mod repeats;
pub mod style;
mod systematic;
pub mod text;
