//! One result, one writer a format.

pub mod demo;
pub mod diagnosis;
pub mod html;
pub mod json;
pub mod paper;
pub mod plan;
pub mod prove;
pub mod text;
