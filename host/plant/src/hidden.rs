//! One hidden effect: its kind, its parameters, its strength.

use super::effects::{Effect, Kind, Law, Param, Random};
use super::{BenchError, Machine};
use std::fmt;

/// A physical effect to hide in the motor. Print it and it reads back: `coulomb:torque=0.01,strength=2`.
#[derive(Clone)]
pub struct Hidden {
    kind: &'static Kind,
    /// The curve, where it is another than the catalogue's own.
    law: Option<&'static Law>,
    values: Vec<f64>,
    strength: f64,
}

impl Hidden {
    /// The effect of that name as it is typical on `machine`: a few per cent of stall torque or supply.
    ///
    /// # Errors
    /// [`BenchError::UnknownEffect`] with the nearest name.
    pub fn typical(name: &str, machine: &Machine) -> Result<Self, BenchError> {
        let kind = Kind::find(name).ok_or_else(|| BenchError::unknown_effect(name))?;
        let values = kind
            .params
            .iter()
            .map(|param| (param.typical)(machine))
            .collect();
        Ok(Hidden {
            kind,
            law: None,
            values,
            strength: 1.0,
        })
    }

    /// Reads `name`, or `name:key=value,key=value` with the parameters in SI units and perhaps
    /// `strength=…`; what is not given is typical on `machine`.
    ///
    /// # Errors
    /// Names the part that cannot be read, with the nearest name, and the range of a value.
    pub fn parse(spec: &str, machine: &Machine) -> Result<Self, BenchError> {
        let (name, settings) = spec.split_once(':').unwrap_or((spec, ""));
        let mut hidden = Self::typical(name.trim(), machine)?;
        for part in settings
            .split(',')
            .map(str::trim)
            .filter(|part| !part.is_empty())
        {
            let (key, text) = part
                .split_once('=')
                .ok_or_else(|| BenchError::NotAnAssignment {
                    spec: spec.into(),
                    part: part.into(),
                })?;
            match key.trim() {
                LAW => hidden = hidden.by_law(text.trim())?,
                key => hidden.set_text(key, text.trim())?,
            }
        }
        Ok(hidden)
    }

    /// Sets the parameter `key`, in its SI unit, or the `strength`.
    ///
    /// # Errors
    /// [`BenchError::UnknownParameter`] with the nearest name; [`BenchError::OutOfRange`].
    pub fn set(&mut self, key: &str, value: f64) -> Result<(), BenchError> {
        if key == STRENGTH.name {
            self.strength = self.checked(&STRENGTH, value)?;
            return Ok(());
        }
        let (index, param) = self.param(key)?;
        self.values[index] = self.checked(param, value)?;
        Ok(())
    }

    /// The same effect, `strength` times as strong as typical or as set; 0 leaves the plain machine.
    ///
    /// # Errors
    /// [`BenchError::OutOfRange`] unless `strength` is finite and not negative.
    pub fn scaled(mut self, strength: f64) -> Result<Self, BenchError> {
        self.set(STRENGTH.name, strength)?;
        Ok(self)
    }

    /// The same effect by another curve of the catalogue.
    ///
    /// # Errors
    /// [`BenchError::UnknownLaw`] where the effect has no curve of that name.
    pub fn by_law(mut self, name: &str) -> Result<Self, BenchError> {
        let mut laws = self.kind.other_laws.iter();
        let found = laws.find(|law| law.name == name);
        self.law = Some(found.ok_or_else(|| BenchError::unknown_law(self.kind, name))?);
        Ok(self)
    }

    /// Draws the parameters that give the effect its form rather than its size; those that are not drawn stay.
    ///
    /// # Errors
    /// [`BenchError::OutOfRange`] where the effect draws what it does not allow.
    pub fn draw_form(
        &mut self,
        machine: &Machine,
        random: &mut dyn Random,
    ) -> Result<(), BenchError> {
        for (key, value) in (self.kind.draw)(&self.effective(), machine, random) {
            self.set(key, value)?;
        }
        Ok(())
    }

    /// True parameters of the effect in a model that is referred to the winding: see [`Kind::truth`].
    pub fn truth(&self, machine: &Machine, counts_per_rev: u32) -> Vec<f64> {
        let mut truth = (self.kind.truth)(&self.effective(), machine, counts_per_rev);
        let form = self.law.and_then(|law| law.form);
        if let Some((last, form)) = truth.last_mut().zip(form) {
            *last = form;
        }
        truth
    }

    /// The names of its effect's other curves that a model can be, by its last parameter.
    pub fn other_forms(&self) -> impl Iterator<Item = &'static str> {
        let laws = self.kind.other_laws.iter();
        laws.filter(|law| law.form.is_some()).map(|law| law.name)
    }

    /// The effect's name.
    pub fn name(&self) -> &'static str {
        self.kind.name
    }

    /// Its true parameters with the strength applied: name, value, unit.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static str, f64, &'static str)> + '_ {
        let params = self.kind.params.iter();
        params
            .zip(self.effective())
            .map(|(param, value)| (param.name, value, param.unit))
    }

    /// In words, with units: `coulomb: torque = 0.010000 N*m`.
    pub fn described(&self) -> String {
        let parameters: Vec<String> = self
            .parameters()
            .map(|(name, value, unit)| match unit {
                "1" => format!("{name} = {value:.6}"),
                unit => format!("{name} = {value:.6} {unit}"),
            })
            .collect();
        let law = self
            .law
            .map_or(String::new(), |law| format!(" ({})", law.about));
        format!("{}{law}: {}", self.name(), parameters.join(", "))
    }

    /// True if it acts on the armature voltage, and so vanishes behind a current loop.
    pub(super) fn is_electrical(&self) -> bool {
        self.kind.electrical.is_some()
    }

    /// Makes the effect itself.
    ///
    /// # Errors
    /// [`BenchError::OutOfRange`] when the strength carries a parameter out of its range.
    pub(super) fn build(&self, machine: &Machine) -> Result<Box<dyn Effect>, BenchError> {
        let values = self.effective();
        for (param, value) in self.kind.params.iter().zip(&values) {
            self.checked(param, *value)?;
        }
        let build = self.law.map_or(self.kind.build, |law| law.build);
        Ok(build(&values, machine))
    }

    fn effective(&self) -> Vec<f64> {
        let scale = |param: &Param| if param.scales { self.strength } else { 1.0 };
        self.kind
            .params
            .iter()
            .zip(&self.values)
            .map(|(p, value)| value * scale(p))
            .collect()
    }

    fn param(&self, key: &str) -> Result<(usize, &'static Param), BenchError> {
        let mut params = self.kind.params.iter().enumerate();
        params
            .find(|(_, param)| param.name == key)
            .ok_or_else(|| BenchError::unknown_parameter(self.kind, key))
    }

    fn set_text(&mut self, key: &str, text: &str) -> Result<(), BenchError> {
        let unit = if key == STRENGTH.name {
            STRENGTH.unit
        } else {
            self.param(key)?.1.unit
        };
        let value = text.parse().map_err(|_| BenchError::NotANumber {
            effect: self.name(),
            key: key.into(),
            text: text.into(),
            unit,
        })?;
        self.set(key, value)
    }

    fn checked(&self, param: &Param, value: f64) -> Result<f64, BenchError> {
        let (low, high) = param.range;
        if value.is_finite() && (low..=high).contains(&value) {
            return Ok(value);
        }
        Err(BenchError::OutOfRange {
            effect: self.name(),
            key: param.name,
            value,
            low,
            high,
            unit: param.unit,
        })
    }
}

/// The key of the curve.
const LAW: &str = "law";

/// The strength, described like a parameter.
static STRENGTH: Param = Param {
    name: "strength",
    unit: "1",
    about: "multiplies every amplitude of the effect",
    scales: false,
    range: (0.0, f64::INFINITY),
    typical: |_| 1.0,
};

impl fmt::Display for Hidden {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:", self.name())?;
        if let Some(law) = self.law {
            write!(f, "{LAW}={},", law.name)?;
        }
        for (param, value) in self.kind.params.iter().zip(&self.values) {
            write!(f, "{}={value},", param.name)?;
        }
        write!(f, "{}={}", STRENGTH.name, self.strength)
    }
}

impl fmt::Debug for Hidden {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Hidden({self})")
    }
}

#[cfg(test)]
mod tests {
    use super::super::effects::CATALOGUE;
    use super::*;

    #[test]
    fn every_effect_prints_and_reads_back() {
        let machine = Machine::gearmotor();
        for kind in CATALOGUE {
            let hidden = Hidden::typical(kind.name, &machine)
                .unwrap()
                .scaled(0.3)
                .unwrap();
            let laws = kind
                .other_laws
                .iter()
                .map(|law| hidden.clone().by_law(law.name).unwrap());
            for hidden in laws.chain([hidden.clone()]) {
                let again = Hidden::parse(&hidden.to_string(), &machine).unwrap();
                assert_eq!(hidden.to_string(), again.to_string());
                assert!(hidden.build(&machine).is_ok(), "{hidden}");
            }
        }
    }

    #[test]
    fn every_refusal_says_what_was_seen_and_what_is_needed() {
        let cases = [
            ("colomb", "did you mean `coulomb`?"),
            ("coulomb:torq=1", "did you mean `torque`?"),
            ("coulomb:torque", "expected key=value"),
            ("brush_drop:law=tan", "did you mean `tanh`?"),
            ("coulomb:law=tanh", "has no law `tanh`"),
            (
                "coulomb:torque=big",
                "`big` is not a number; give one in N*m",
            ),
            ("coulomb:torque=-1", "needs 0 to inf N*m"),
            ("coulomb:torque=nan", "needs 0 to inf N*m"),
            ("coulomb:torque=inf", "needs 0 to inf N*m"),
            ("coulomb:strength=-1", "needs 0 to inf 1"),
        ];
        for (spec, expected) in cases {
            let message = Hidden::parse(spec, &Machine::paper())
                .unwrap_err()
                .to_string();
            assert!(message.contains(expected), "{spec}: {message}");
        }
    }
}
