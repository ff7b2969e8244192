//! The forms of law that no effect of the catalogue states.

mod angle;
mod drag;
mod drive;
mod friction;
mod load;

use super::{Outside, Variable};
use crate::{Chance, Machine};

const NOTHING: Outside = Outside {
    name: "",
    about: "",
    draw: |_, _| Vec::new(),
    torque: |_, _| 0.0,
    friction: |_, _| 0.0,
    volts: |_, _| 0.0,
    inertia: |_, _| [0.0; 2],
    memory: None,
    jump_rad_s: None,
    depends_on: &[Variable::Speed],
};

/// Parts of a machine's stall torque, as large as effects of the catalogue typically are.
fn torque(machine: &Machine, chance: &mut Chance) -> f64 {
    let part = 0.02 * 4f64.powf(chance.uniform());
    part * machine.stall_torque_n_m()
}

fn between(chance: &mut Chance, low: f64, high: f64) -> f64 {
    low + (high - low) * chance.uniform()
}

/// A part of the top speed, rad/s.
fn speed(machine: &Machine, chance: &mut Chance, low: f64, high: f64) -> f64 {
    between(chance, low, high) * machine.top_speed_rad_s()
}

/// A whole number of cycles in a revolution, and a phase.
fn order_and_phase(chance: &mut Chance, most: f64) -> [f64; 2] {
    let order = between(chance, 1.0, most + 1.0).floor();
    [order, between(chance, 0.0, std::f64::consts::TAU)]
}

/// A torque that is a wave along the angle: `times` the usual size, the reference by a part of which it goes, its order and its phase.
fn wave(machine: &Machine, chance: &mut Chance, times: f64, reference: f64, most: f64) -> Vec<f64> {
    let [order, phase] = order_and_phase(chance, most);
    vec![times * torque(machine, chance), reference, order, phase]
}

impl Outside {
    /// Every form. A proof hides them in this order; a new one comes last, so that the case of a number stays what it was.
    pub const ALL: &'static [&'static Outside] = &[
        &drag::POWER_DRAG,
        &drag::CUBIC_DRAG,
        &drag::SATURATING_DRAG,
        &friction::DECAYING_FRICTION,
        &load::CURRENT_SQUARE,
        &angle::VISCOUS_BY_ANGLE,
        &angle::COULOMB_BY_ANGLE,
        &drive::SATURATING_BACK_EMF,
        &drive::SLEW_LIMIT,
        &load::GEAR_LOSS,
        &angle::CRANK,
        &angle::CRANK_INERTIA,
        &drag::STEP_ABOVE,
        &drag::TANH_FRICTION,
        &drag::ONE_SIDED_DRAG,
        &angle::FADING_RIPPLE,
        &friction::LOAD_FRICTION_THAT_FALLS,
        &drag::EDDY_BRAKE,
        &drag::HUMP_DRAG,
        &drag::LOGARITHMIC_DRAG,
        &drag::RISING_DRAG,
        &friction::RUB,
        &load::LOAD_DRAG,
        &load::CONTACT_DROP,
        &angle::TORQUE_RIPPLE,
        &angle::WINDING_RIPPLE,
        &angle::SPEED_RIPPLE,
        &angle::WINDAGE_BY_ANGLE,
        &drive::QUADRATIC_DRIVE,
        &drive::WEAK_SIDE,
    ];
}
