//! One result, one writer a format.

pub mod demo;
pub mod diagnosis;
pub mod fold;
pub mod html;
pub mod likelihood;
pub mod paper;
pub mod plan;
mod style;
pub mod text;
