//! A law that the user states, on the virtual bench: its text is evaluated as it stands, by none of the code that the model runs.

use servoid_formula::{Law, Point};
use servoid_plant::Machine;
use servoid_plant::effects::{At, Effect, Sliding};
use shared::effects::formula::Output;
use std::f64::consts::TAU;

/// A law with the values of its parameters, in a machine.
pub struct StatedLaw {
    law: &'static Law,
    values: Vec<f64>,
    machine: Machine,
    /// Whether it depends on the time, which it then remembers.
    ages: bool,
}

impl StatedLaw {
    /// With the values from which a search would start.
    pub fn new(law: &'static Law, machine: Machine) -> Self {
        let values = law.definition.parameters.iter().map(|p| p.start).collect();
        StatedLaw {
            law,
            values,
            machine,
            ages: law.definition.ages(),
        }
    }

    /// The law where it gives `output`, else nothing.
    fn value(&self, output: Output, point: &Point) -> Option<f64> {
        let definition = &self.law.definition;
        (definition.output == output).then(|| definition.value(&self.values, point))
    }

    /// A voltage referred to the winding, as a torque in N·m.
    fn torque_n_m(&self, volts: f64) -> f64 {
        volts / self.machine.winding_volts(1.0)
    }

    fn point(&self, at: &At) -> Point {
        let current = at.current * self.machine.resistance_ohm;
        Point {
            speed: at.speed,
            angle: at.angle.rem_euclid(TAU),
            current,
            transmitted: current,
            command: at.volts,
            time: if self.ages { at.memory[0] } else { 0.0 },
            // The bench tells none: such laws are refused before.
            temperature: 0.0,
            states: at.memory,
        }
    }
}

/// Step of the state or of the angle, rad, by which a law is differentiated.
const STEP: f64 = 1e-4;

impl Effect for StatedLaw {
    fn volts(&self, volts: f64, at: &At) -> f64 {
        let added = self.value(Output::Voltage, &self.point(at));
        volts + added.unwrap_or(0.0)
    }

    fn torque(&self, at: &At) -> f64 {
        let point = self.point(at);
        let part = self.value(Output::TorqueConstant, &point).unwrap_or(1.0);
        let added = self.value(Output::Torque, &point).unwrap_or(0.0);
        self.torque_n_m(added + point.current * (part - 1.0))
    }

    fn friction(&self, sliding: &Sliding) -> f64 {
        let transmitted = self.machine.winding_volts(sliding.transmitted);
        let point = Point {
            speed: sliding.direction * sliding.speed,
            angle: sliding.angle.rem_euclid(TAU),
            current: transmitted,
            transmitted,
            command: sliding.volts,
            ..Point::default()
        };
        let budget = self.value(Output::Friction, &point).unwrap_or(0.0);
        self.torque_n_m(budget.max(0.0))
    }

    fn inertia(&self, angle: f64) -> [f64; 2] {
        let at = |angle: f64| {
            let point = Point {
                angle: angle.rem_euclid(TAU),
                ..Point::default()
            };
            let part = self.value(Output::Inertia, &point).unwrap_or(0.0);
            part.max(0.0) * self.machine.inertia_kg_m2
        };
        let slope = (at(angle + STEP) - at(angle - STEP)) / (2.0 * STEP);
        [at(angle), slope]
    }

    fn memories(&self) -> usize {
        self.law.definition.states.len().max(usize::from(self.ages))
    }

    fn memory_rates(&self, at: &At) -> [f64; 2] {
        if self.ages {
            return [1.0, 0.0];
        }
        self.law.definition.rates(&self.values, &self.point(at))
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        // The largest sum of a row bounds every eigenvalue (Gershgorin).
        let mut rows = [0.0f64; 2];
        for place in 0..self.law.definition.states.len() {
            let rates = |step: f64| {
                let mut memory = at.memory;
                memory[place] += step;
                self.memory_rates(&At { memory, ..*at })
            };
            let (more, less) = (rates(STEP), rates(-STEP));
            for (row, (more, less)) in rows.iter_mut().zip(more.into_iter().zip(less)) {
                *row += ((more - less) / (2.0 * STEP)).abs();
            }
        }
        rows[0].max(rows[1])
    }

    fn sensed_angle(&self, angle: f64) -> f64 {
        let point = Point {
            angle: angle.rem_euclid(TAU),
            ..Point::default()
        };
        angle + self.value(Output::Angle, &point).unwrap_or(0.0)
    }
}
