//! One result, one writer a format.

pub mod demo;
pub mod diagnosis;
pub mod fold;
pub mod json;
pub mod paint;
pub mod paper;
pub mod plan;
pub mod sheet;
pub mod text;
