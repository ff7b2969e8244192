//! The true machine on the bench: a brushed DC motor in plain SI units.

use super::BenchError;
use serde::{Deserialize, Serialize};

/// True parameters of an armature-controlled DC motor, all referred to the motor shaft.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Supply voltage, V: the largest voltage that the drive can command.
    pub supply_v: f64,
    /// Armature resistance R, Ω.
    pub resistance_ohm: f64,
    /// Armature inductance L, H.
    pub inductance_h: f64,
    /// Torque constant Kt, N·m/A.
    pub kt_n_m_a: f64,
    /// Back-EMF constant Kb, V·s/rad.
    pub kb_v_s_rad: f64,
    /// Moment of inertia J of rotor and load, kg·m².
    pub inertia_kg_m2: f64,
    /// Viscous friction b, N·m·s/rad.
    pub viscous_n_m_s: f64,
}

/// Names that [`Machine::preset`] knows.
pub const PRESETS: &[&str] = &["paper", "gearmotor", "coreless_24v", "servo_400w"];

impl Machine {
    /// The motor of the paper (IJAPE 14(1), 2025, table 1); its time constants are L/R = 17 ms and
    /// RJ/K² = 0.2 s. The paper drives it with 1 V, the bench with up to 12 V.
    pub const fn paper() -> Self {
        Machine {
            resistance_ohm: 1.2,
            inductance_h: 0.02,
            kt_n_m_a: 0.06,
            kb_v_s_rad: 0.06,
            inertia_kg_m2: 6.2e-4,
            viscous_n_m_s: 1e-4,
            supply_v: 12.0,
        }
    }

    /// The small 12 V motor of a hobby gear head, seen at its own shaft: L/R = 0.26 ms, RJ/K² = 25 ms.
    pub const fn gearmotor() -> Self {
        Machine {
            resistance_ohm: 2.3,
            inductance_h: 6e-4,
            kt_n_m_a: 0.017,
            kb_v_s_rad: 0.017,
            inertia_kg_m2: 3.2e-6,
            viscous_n_m_s: 1e-6,
            supply_v: 12.0,
        }
    }

    /// A fast coreless 24 V motor with a small disc on its shaft: L/R = 52 µs, RJ/K² = 8.4 ms.
    pub const fn coreless_24v() -> Self {
        Machine {
            resistance_ohm: 2.3,
            inductance_h: 1.2e-4,
            kt_n_m_a: 0.0234,
            kb_v_s_rad: 0.0234,
            inertia_kg_m2: 2e-6,
            viscous_n_m_s: 5e-7,
            supply_v: 24.0,
        }
    }

    /// A 400 W servo motor on 80 V: L/R = 3 ms and RJ/K² = 8 ms, so that its two poles lie close.
    pub const fn servo_400w() -> Self {
        Machine {
            resistance_ohm: 1.0,
            inductance_h: 3e-3,
            kt_n_m_a: 0.25,
            kb_v_s_rad: 0.25,
            inertia_kg_m2: 5e-4,
            viscous_n_m_s: 5e-4,
            supply_v: 80.0,
        }
    }

    /// The preset of that name, one of [`PRESETS`].
    ///
    /// # Errors
    /// [`BenchError::UnknownMachine`] with the nearest name.
    pub fn preset(name: &str) -> Result<Self, BenchError> {
        match name {
            "paper" => Ok(Self::paper()),
            "gearmotor" => Ok(Self::gearmotor()),
            "coreless_24v" => Ok(Self::coreless_24v()),
            "servo_400w" => Ok(Self::servo_400w()),
            _ => Err(BenchError::unknown_machine(name)),
        }
    }

    /// Current of the stalled motor on the full supply, A.
    pub fn stall_current_a(&self) -> f64 {
        self.supply_v / self.resistance_ohm
    }

    /// Torque of the stalled motor on the full supply, N·m.
    pub fn stall_torque_n_m(&self) -> f64 {
        self.kt_n_m_a * self.stall_current_a()
    }

    /// Speed that the machine settles at on `volts` with no load but its own viscous friction, rad/s.
    pub fn no_load_speed_rad_s(&self, volts: f64) -> f64 {
        volts * self.kt_n_m_a
            / (self.kt_n_m_a * self.kb_v_s_rad + self.resistance_ohm * self.viscous_n_m_s)
    }

    /// No-load speed on the full supply, rad/s.
    pub fn top_speed_rad_s(&self) -> f64 {
        self.no_load_speed_rad_s(self.supply_v)
    }

    /// Voltage that the winding spends on a torque, N·m (or on a damping or a drag, per its unit).
    pub fn winding_volts(&self, torque_n_m: f64) -> f64 {
        torque_n_m * self.resistance_ohm / self.kt_n_m_a
    }

    /// A coefficient of the squared current, 1/A², per squared voltage across the resistance.
    pub fn per_square_volt(&self, per_square_ampere: f64) -> f64 {
        per_square_ampere / (self.resistance_ohm * self.resistance_ohm)
    }

    /// Refuses values that no motor has.
    pub(super) fn check(&self) -> Result<(), BenchError> {
        let positive = [
            ("machine.resistance_ohm", self.resistance_ohm),
            ("machine.inductance_h", self.inductance_h),
            ("machine.kt_n_m_a", self.kt_n_m_a),
            ("machine.kb_v_s_rad", self.kb_v_s_rad),
            ("machine.inertia_kg_m2", self.inertia_kg_m2),
            ("machine.supply_v", self.supply_v),
        ];
        for (setting, value) in positive {
            BenchError::require(
                value > 0.0 && value.is_finite(),
                setting,
                value,
                "above zero",
            )?;
        }
        let viscous = self.viscous_n_m_s;
        BenchError::require(
            viscous >= 0.0 && viscous.is_finite(),
            "machine.viscous_n_m_s",
            viscous,
            "zero or above",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_listed_preset_exists_and_is_a_possible_motor() {
        for name in PRESETS {
            Machine::preset(name).unwrap().check().unwrap();
        }
    }

    #[test]
    fn a_misspelt_preset_names_its_neighbour() {
        let message = Machine::preset("gear_motor").unwrap_err().to_string();
        assert!(message.contains("gearmotor"), "{message}");
    }
}
