//! The motor's state and its differential equations.
//!
//! ```text
//! L di/dt   = v − R i − Kb ω                        armature (Krause et al., "Analysis of Electric
//! J dω/dt   = Kt i − b ω + ΣT − Tshaft − F sgn ω    Machinery": machine with a constant field)
//!             − ½ ω² dJ/dθ                           for a J that the angle changes
//! Jl dωl/dt = Tshaft − Fl sgn ωl                   load side, if there is one
//! ```
//!
//! F is the budget of dry friction, Fl that of the load. The shaft is either sliding in a known direction or held, and a load
//! behind a gap is driven forward, backward or not at all: [`Grip`] and [`Flank`] fix that while
//! the equations are evaluated, so that their right-hand side is smooth. `integrate` moves the
//! state forward and changes both when it is time.

use super::bridge::{Bridge, Legs};
use super::coupling::{Flank, Shaft};
use super::effects::{At, Effect, Sliding, Winding};
use super::{Coupling, Machine};
use std::ops::Range;
use std::sync::Arc;

/// Most numbers that effects remember at once: those of the catalogue, one from outside of it and the caller's.
const MEMORIES: usize = 8;
/// Most numbers that the caller's effects remember at once.
pub const STATED_MEMORIES: usize = 4;
/// What the bridge feeds to the armature.
#[derive(Clone, Copy, Debug)]
pub(super) enum Feed {
    /// A voltage, V.
    Volts(f64),
    /// A current that the amplifier enforces, A.
    Amps(f64),
    /// Nothing: the bridge is open.
    Open,
}

/// What changes with time; also used for its rate of change.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub(super) angle: f64,
    pub(super) speed: f64,
    pub(super) current: f64,
    load_angle: f64,
    pub(super) load_speed: f64,
    memory: [f64; MEMORIES],
}

impl State {
    pub(super) fn ahead(&self, rate: &State, dt: f64) -> State {
        let mut next = *self;
        next.angle += dt * rate.angle;
        next.speed += dt * rate.speed;
        next.current += dt * rate.current;
        next.load_angle += dt * rate.load_angle;
        next.load_speed += dt * rate.load_speed;
        for (value, rate) in next.memory.iter_mut().zip(&rate.memory) {
            *value += dt * rate;
        }
        next
    }
}

/// How dry friction grips the shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grip {
    /// There is no dry friction.
    None,
    /// The shaft slides in direction +1 or −1.
    Sliding(f64),
    /// Friction holds the shaft at rest.
    Held,
}

/// Torques on the motor shaft but for dry friction, N·m.
pub(super) struct Torques {
    pub(super) net: f64,
    /// From the motor to its load, with its sign.
    pub(super) transmitted: f64,
    /// From the motor side to the load side of the coupling.
    pub(super) shaft: f64,
}

/// The machine with its effects, in motion.
pub(super) struct Plant<'a> {
    pub(super) machine: Machine,
    pub(super) effects: &'a [Arc<dyn Effect>],
    /// Indices into the state's memory, for each effect.
    memory_of: Vec<Range<usize>>,
    pub(super) shaft: Option<Shaft>,
    pub(super) motor_inertia_kg_m2: f64,
    pub(super) substep_hz: f64,
    pub(super) grip: Grip,
    /// How dry friction grips the load.
    pub(super) load_grip: Grip,
    pub(super) flank: Flank,
    pub(super) pieces: i64,
    /// The bridge that switches, with its place among the effects.
    pub(super) bridge: Option<(usize, Bridge)>,
    /// What its legs are connected to in this substep.
    pub(super) legs: Option<Legs>,
    /// The side of those that the current chose as the substep began.
    pub(super) side: i8,
    /// Time since the start, s.
    pub(super) clock_s: f64,
    pub(super) state: State,
    /// A torque on the shaft from outside, N·m.
    pub(super) disturbance_n_m: f64,
    /// What the drive gives, V; nothing while the bridge is open or closes a current loop.
    pub(super) drive_v: f64,
}

impl<'a> Plant<'a> {
    /// The machine at rest at `angle` rad, without current.
    pub(super) fn new(
        machine: Machine,
        effects: &'a [Arc<dyn Effect>],
        substep_hz: f64,
        angle: f64,
    ) -> Self {
        let coupling = effects
            .iter()
            .filter_map(|e| e.coupling())
            .reduce(Coupling::in_series_with);
        let shaft = coupling.map(|coupling| Shaft::new(coupling, machine.inertia_kg_m2));
        let state = State {
            angle,
            speed: 0.0,
            current: 0.0,
            load_angle: angle,
            load_speed: 0.0,
            memory: [0.0; MEMORIES],
        };
        let mut used = 0;
        let memory_of: Vec<_> = effects
            .iter()
            .map(|effect| {
                let own = used..used + effect.memories();
                used = own.end;
                own
            })
            .collect();
        let mut plant = Plant {
            machine,
            effects,
            memory_of,
            motor_inertia_kg_m2: shaft.map_or(machine.inertia_kg_m2, |s| s.motor_inertia_kg_m2),
            shaft,
            substep_hz,
            grip: Grip::None,
            load_grip: match shaft {
                Some(shaft) if shaft.friction_n_m > 0.0 => Grip::Held,
                _ => Grip::None,
            },
            flank: Flank::None,
            pieces: 0,
            bridge: effects
                .iter()
                .enumerate()
                .find_map(|(index, effect)| Some((index, effect.bridge()?))),
            legs: None,
            side: 0,
            clock_s: 0.0,
            state,
            disturbance_n_m: 0.0,
            drive_v: 0.0,
        };
        let stall = machine.stall_torque_n_m();
        if [1.0, -1.0]
            .iter()
            .any(|direction| plant.budget(*direction, 0.0, stall, angle) > 0.0)
        {
            plant.grip = Grip::Held;
        }
        plant
    }

    /// The right-hand side of the differential equations.
    pub(super) fn rate(&self, feed: Feed, state: &State) -> State {
        let winding = self.winding(state);
        let torques = self.torques(state, &winding);
        let accelerating = match self.grip {
            Grip::None => torques.net,
            Grip::Sliding(direction) => {
                let speed = (direction * state.speed).max(0.0);
                let budget = self.budget(direction, speed, torques.transmitted, state.angle);
                torques.net - direction * budget
            }
            Grip::Held => 0.0,
        };
        let mut volts = match feed {
            Feed::Volts(command) => command,
            Feed::Amps(_) | Feed::Open => 0.0,
        };
        let mut memory = [0.0; MEMORIES];
        for (index, effect) in self.effects.iter().enumerate() {
            let at = At {
                volts,
                ..self.at(index, state)
            };
            let own = self.memory_of[index].clone();
            if !own.is_empty() {
                let rates = effect.memory_rates(&at);
                memory[own.clone()].copy_from_slice(&rates[..own.len()]);
            }
            volts = match (self.bridge, &self.legs) {
                (Some((switching, bridge)), Some(legs)) if switching == index => {
                    let emf = winding.kb_v_s_rad * state.speed;
                    let still = emf + winding.resistance_ohm * state.current;
                    bridge.volts(legs, self.side, emf, still)
                }
                _ => effect.volts(volts, &at),
            };
        }
        let [mut inertia, mut by_angle] = [self.motor_inertia_kg_m2, 0.0];
        for effect in self.effects {
            let [more, slope] = effect.inertia(state.angle);
            inertia += more;
            by_angle += slope;
        }
        State {
            angle: state.speed,
            speed: (accelerating - 0.5 * by_angle * state.speed * state.speed) / inertia,
            current: match feed {
                Feed::Volts(_) => Self::current_rate(volts, state, &winding),
                Feed::Amps(_) | Feed::Open => 0.0,
            },
            load_angle: state.load_speed,
            load_speed: self.shaft.map_or(0.0, |shaft| {
                let accelerating = match self.load_grip {
                    Grip::None => torques.shaft,
                    Grip::Sliding(direction) => torques.shaft - direction * shaft.friction_n_m,
                    Grip::Held => 0.0,
                };
                accelerating / shaft.load_inertia_kg_m2
            }),
            memory,
        }
    }

    fn current_rate(volts: f64, state: &State, winding: &Winding) -> f64 {
        let back_emf = winding.kb_v_s_rad * state.speed;
        (volts - winding.resistance_ohm * state.current - back_emf) / winding.inductance_h
    }

    pub(super) fn torques(&self, state: &State, winding: &Winding) -> Torques {
        let motor = winding.kt_n_m_a * state.current;
        let mut external = self.disturbance_n_m;
        for (index, effect) in self.effects.iter().enumerate() {
            external += effect.torque(&self.at(index, state));
        }
        let shaft = self.shaft.map_or(0.0, |shaft| {
            let twist = state.angle - state.load_angle;
            shaft.torque(self.flank, twist, state.speed - state.load_speed)
        });
        Torques {
            net: motor - self.machine.viscous_n_m_s * state.speed + external - shaft,
            transmitted: motor - external,
            shaft,
        }
    }

    pub(super) fn winding(&self, state: &State) -> Winding {
        let mut winding = Winding {
            resistance_ohm: self.machine.resistance_ohm,
            inductance_h: self.machine.inductance_h,
            kt_n_m_a: self.machine.kt_n_m_a,
            kb_v_s_rad: self.machine.kb_v_s_rad,
        };
        for (index, effect) in self.effects.iter().enumerate() {
            effect.winding(&mut winding, &self.at(index, state));
        }
        winding
    }

    pub(super) fn budget(&self, direction: f64, speed: f64, transmitted: f64, angle: f64) -> f64 {
        let sliding = Sliding {
            direction,
            speed,
            transmitted: transmitted.abs(),
            angle,
            volts: self.drive_v,
        };
        self.effects
            .iter()
            .map(|effect| effect.friction(&sliding))
            .sum()
    }

    /// What the drive gives to a motor at this instant, V.
    pub(super) fn driven(&self, feed: Feed) -> f64 {
        let Feed::Volts(command) = feed else {
            return 0.0;
        };
        self.behind(command, self.effects)
    }

    /// The voltage behind some effects, the first ones of the motor, from the command, V: the mean of what a bridge switches.
    pub(super) fn behind(&self, command: f64, effects: &[Arc<dyn Effect>]) -> f64 {
        let effects = effects.iter().enumerate();
        effects.fold(command, |volts, (index, effect)| {
            let at = At {
                volts,
                ..self.at(index, &self.state)
            };
            effect.volts(volts, &at)
        })
    }

    /// The pieces of all effects' laws in one number, its digits in base 3.
    pub(super) fn pieces_at(&self, state: &State) -> i64 {
        let transmitted = match self.grip {
            Grip::None => 0.0,
            _ => self.torques(state, &self.winding(state)).transmitted,
        };
        let effects = self.effects.iter().enumerate();
        effects.fold(0, |digits, (index, effect)| {
            3 * digits + i64::from(effect.piece(&self.at(index, state), transmitted))
        })
    }

    /// The side of the bridge that a current chooses.
    pub(super) fn side_at(&self, state: &State) -> i8 {
        match (self.bridge, &self.legs) {
            (Some((_, bridge)), Some(legs)) => bridge.side(legs, state.current),
            _ => 0,
        }
    }

    pub(super) fn flank_at(&self, state: &State) -> Flank {
        let twist = state.angle - state.load_angle;
        let rate = state.speed - state.load_speed;
        self.shaft
            .map_or(Flank::None, |shaft| shaft.flank(twist, rate))
    }

    pub(super) fn at(&self, index: usize, state: &State) -> At {
        At {
            angle: state.angle,
            speed: state.speed,
            current: state.current,
            volts: self.drive_v,
            memory: {
                let own = self.memory_of[index].clone();
                let mut memory = [0.0; 2];
                memory[..own.len()].copy_from_slice(&state.memory[own]);
                memory
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::Hidden;
    use super::super::effects::CATALOGUE;
    use super::*;

    #[test]
    fn there_is_room_for_every_memory_of_the_catalogue() {
        let machine = Machine::paper();
        let build = |name| {
            Hidden::typical(name, &machine)
                .unwrap()
                .build(&machine)
                .unwrap()
        };
        let effects = CATALOGUE.iter().map(|kind| build(kind.name));
        let catalogue: usize = effects.map(|effect| effect.memories()).sum();
        assert!(catalogue + 1 + STATED_MEMORIES <= MEMORIES, "{catalogue}");
    }
}
