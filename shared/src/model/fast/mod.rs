//! Shorter forms of one and the same step. A newcomer may skip this folder: each form gives what
//! [`Model::step`](super::Model::step) gives, bit for bit, and `shared/tests/fast_forms.rs` is the law that says so.
//!
//! | form | when it applies | what it saves | who uses it |
//! |---|---|---|---|
//! | [`ConstantForce`] | forces that do not depend on the state, bridge closed | products with voltage and friction, made once | the host's searches, in every lane |
//! | [`Rigid`] | one rigid body with Coulomb friction and a constant load | memory: it fits beside a recording on a small device | the device's fit |
//! | `dead_time` | behind a bridge of two legs | what that takes, as the mean of a carrier wave | [`Rigid`] |
//! | `friction_event` | friction on one rigid body, one candidate | computes of each trial only what is asked | [`Rigid`] |
//! | [`Increments`] | no effects, bridge closed | everything but the linear map itself, for many steps at once | the host's searches, exports |
//!
//! The device's hot loop is no form of this step and stands in [`fit`](crate::fit) beside the sums that it feeds: it takes raw
//! duties and counts, orders its products for one core's multiplier, and differs from [`Rigid::step`] in rounding.

mod constant_force;
mod dead_time;
mod friction_event;
mod linear;
mod rigid;

pub use constant_force::ConstantForce;
pub use linear::Increments;
pub use rigid::{Rigid, RigidPlan};
