//! The motor on the bench: armature, rotor, dry friction. Nothing here is shared with the firmware's model of it.

/// Parameters of the motor, SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motor {
    /// Armature resistance, Ω.
    pub resistance: f64,
    /// Armature inductance, H.
    pub inductance: f64,
    /// Torque constant, N·m/A.
    pub torque_constant: f64,
    /// Back-EMF constant, V·s/rad.
    pub back_emf: f64,
    /// Inertia of rotor and load, kg·m².
    pub inertia: f64,
    /// Viscous friction, N·m·s/rad.
    pub viscous: f64,
    /// Dry friction while it turns, N·m.
    pub coulomb: f64,
    /// Dry friction that holds it at rest, N·m; at least `coulomb`.
    pub holding: f64,
}

/// State of the terminals.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Terminal {
    /// A voltage, V.
    Driven(f64),
    /// No transistor conducts; the diodes lead the current back into a supply of this many volts until it has died out.
    Open(f64),
}

/// State of the motor.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct State {
    /// Armature current, A.
    pub current: f64,
    /// Speed, rad/s.
    pub speed: f64,
    /// Angle, rad.
    pub angle: f64,
}

/// Forward voltage of the bridge's diodes, V.
const DIODE: f64 = 0.8;
/// The longest step of the integration, s. A fiftieth of a short electrical time constant.
const LONGEST_STEP: f64 = 2e-6;

impl State {
    /// Lets `seconds` pass.
    pub fn advance(&mut self, motor: &Motor, terminal: Terminal, locked: bool, seconds: f64) {
        let steps = (seconds / LONGEST_STEP).ceil().max(1.0);
        for _ in 0..steps as u32 {
            self.step(motor, terminal, locked, seconds / steps);
        }
    }

    fn step(&mut self, motor: &Motor, terminal: Terminal, locked: bool, h: f64) {
        let before = *self;
        self.current = electrical(&before, motor, terminal, h);
        // The mean of the current over the step drives the rotor: second order, as the midpoint rule.
        let torque = motor.torque_constant * 0.5 * (before.current + self.current);
        self.speed = if locked {
            0.0
        } else {
            mechanical(before.speed, torque, motor, h)
        };
        self.angle += 0.5 * (before.speed + self.speed) * h;
    }
}

/// The current after a step of `h`: exact for a speed that stands still during it.
fn electrical(state: &State, motor: &Motor, terminal: Terminal, h: f64) -> f64 {
    let emf = motor.back_emf * state.speed;
    let decay = (-motor.resistance / motor.inductance * h).exp();
    let towards = |volts: f64| {
        let end = (volts - emf) / motor.resistance;
        end + (state.current - end) * decay
    };
    match terminal {
        Terminal::Driven(volts) => towards(volts),
        Terminal::Open(supply) => {
            let clamp = supply + 2.0 * DIODE;
            // At rest the diodes conduct only if the motor generates more than the supply.
            let flows = if state.current != 0.0 {
                state.current
            } else if emf.abs() > clamp {
                -emf
            } else {
                return 0.0;
            };
            let after = towards(-clamp.copysign(flows));
            if after * flows > 0.0 { after } else { 0.0 }
        }
    }
}

/// The speed after a step of `h` under `torque`. Dry friction opposes motion and may stop it within the step; it then
/// holds, or if the torque exceeds what it can hold the rotor turns back in what is left of the step. (If it waited for the
/// next one, each reversal of a strong motor would cost its fast encoder a count.)
fn mechanical(speed: f64, torque: f64, motor: &Motor, h: f64) -> f64 {
    let acceleration = |speed: f64, sense: f64| {
        (torque - motor.coulomb.copysign(sense) - motor.viscous * speed) / motor.inertia
    };
    let mut left = h;
    if speed != 0.0 {
        let braking = acceleration(speed, speed);
        let after = speed + braking * h;
        if after * speed > 0.0 {
            return after;
        }
        left += speed / braking;
    }
    if torque.abs() <= motor.holding {
        return 0.0;
    }
    acceleration(0.0, torque) * left
}

#[cfg(test)]
mod tests {
    use super::*;

    pub const MAXON: Motor = Motor {
        resistance: 1.2,
        inductance: 0.5e-3,
        torque_constant: 0.06,
        back_emf: 0.06,
        inertia: 6.2e-5,
        viscous: 2.0e-5,
        coulomb: 5e-3,
        holding: 6e-3,
    };

    fn after(motor: &Motor, start: State, terminal: Terminal, seconds: f64) -> State {
        let mut state = start;
        for _ in 0..(seconds / 25e-6).round() as u32 {
            state.advance(motor, terminal, false, 25e-6);
        }
        state
    }

    #[test]
    fn it_settles_where_the_equations_of_steady_running_say() {
        let m = MAXON;
        for volts in [3.0, 12.0, 24.0, -24.0_f64] {
            let state = after(&m, State::default(), Terminal::Driven(volts), 2.0);
            let d = m.torque_constant * m.back_emf + m.resistance * m.viscous;
            let speed = (m.torque_constant * volts - m.resistance * m.coulomb.copysign(volts)) / d;
            let current = (m.coulomb.copysign(volts) + m.viscous * speed) / m.torque_constant;
            assert!((state.speed / speed - 1.0).abs() < 1e-6, "{state:?}");
            assert!((state.current / current - 1.0).abs() < 1e-6, "{state:?}");
        }
    }

    #[test]
    fn dry_friction_holds_below_its_limit_and_lets_go_above() {
        let m = MAXON;
        let limit = m.holding / m.torque_constant * m.resistance;
        let held = after(&m, State::default(), Terminal::Driven(0.99 * limit), 1.0);
        assert_eq!((held.speed, held.angle), (0.0, 0.0));
        let free = after(&m, State::default(), Terminal::Driven(1.01 * limit), 1.0);
        assert!(free.speed > 0.3, "{free:?}");
    }

    #[test]
    fn a_reversal_under_torque_takes_no_longer_however_long_the_steps() {
        let torque = -3.0 * MAXON.holding;
        let slowing = (torque - MAXON.coulomb) / MAXON.inertia;
        let turning = (torque + MAXON.coulomb) / MAXON.inertia;
        let m = Motor {
            viscous: 0.0,
            ..MAXON
        };
        for steps in 1..40 {
            let h = 2e-3 / f64::from(steps);
            let mut speed = 0.1;
            for _ in 0..steps {
                speed = mechanical(speed, torque, &m, h);
            }
            let exact = turning * (2e-3 + 0.1 / slowing);
            assert!(
                (speed / exact - 1.0).abs() < 1e-9,
                "{speed} of {exact} in {steps}"
            );
        }
    }

    #[test]
    fn an_open_bridge_ends_the_current_and_friction_then_stops_the_rotor_for_good() {
        let m = MAXON;
        let running = after(&m, State::default(), Terminal::Driven(24.0), 1.0);
        let open = after(&m, running, Terminal::Open(24.0), 0.001);
        assert_eq!(open.current, 0.0);
        // Without current: J dω/dt = −b ω − c, so the rotor stops after J/b ln(1 + b ω/c).
        let stops = m.inertia / m.viscous * (m.viscous * running.speed / m.coulomb).ln_1p();
        let nearly = after(&m, running, Terminal::Open(24.0), 0.98 * stops);
        let stopped = after(&m, running, Terminal::Open(24.0), 1.02 * stops);
        assert!(
            nearly.speed > 0.0 && stopped.speed == 0.0,
            "{nearly:?} {stopped:?}"
        );
        assert_eq!(
            after(&m, stopped, Terminal::Open(24.0), 0.5).angle,
            stopped.angle
        );
    }

    #[test]
    fn the_energy_that_the_supply_gives_is_found_again_as_heat_and_motion() {
        let m = Motor {
            coulomb: 0.0,
            holding: 0.0,
            ..MAXON
        };
        let mut state = State::default();
        let (mut given, mut heat) = (0.0, 0.0);
        let h = LONGEST_STEP;
        for k in 0..500_000 {
            let volts = if (k / 50_000) % 2 == 0 { 24.0 } else { -7.0 };
            let before = state;
            state.advance(&m, Terminal::Driven(volts), false, h);
            let current = 0.5 * (before.current + state.current);
            let speed = 0.5 * (before.speed + state.speed);
            given += volts * current * h;
            heat += (m.resistance * current * current + m.viscous * speed * speed) * h;
        }
        let stored = 0.5 * (m.inertia * state.speed.powi(2) + m.inductance * state.current.powi(2));
        assert!(
            ((heat + stored) / given - 1.0).abs() < 1e-3,
            "{} of {given} J",
            heat + stored
        );
    }
}
