//! Laws outside the catalogue: what a motor may hide that no effect of the catalogue states.
//!
//! They serve to judge whether a program finds the law itself from a recording. A law is hidden by
//! [`Bench::outside`](super::Bench::outside), beside effects of the catalogue or alone, and [`OutsideLaw::given`] tells the truth.

mod forms;

use crate::effects::{At, Effect, Sliding};
use crate::run::Run;
use crate::{Chance, Machine};

/// One form of law.
pub struct Outside {
    /// Its name.
    pub name: &'static str,
    /// Its equation, in a line.
    pub about: &'static str,
    /// Draws parameters, SI, that are typical on a machine.
    draw: fn(&Machine, &mut Chance) -> Vec<f64>,
    /// Torque added to the shaft, N·m.
    torque: fn(&[f64], &At) -> f64,
    /// Budget of dry friction, N·m.
    friction: fn(&[f64], &Sliding) -> f64,
    /// Voltage added at the winding, V.
    volts: fn(&[f64], &At) -> f64,
    /// Moment of inertia added at an angle, kg·m², and its slope along the angle.
    inertia: fn(&[f64], f64) -> [f64; 2],
    /// What it remembers.
    memory: Option<Remembered>,
    /// Speed at which the law jumps, rad/s.
    jump_rad_s: Option<fn(&[f64]) -> f64>,
    /// What it depends on.
    depends_on: &'static [Variable],
}

/// What a law may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Variable {
    /// Speed.
    Speed,
    /// Angle within the revolution.
    Angle,
    /// Current or command.
    Load,
    /// The way since the last reversal, or the command before.
    Memory,
}

/// What a law remembers, from its parameters.
#[derive(Clone, Copy)]
enum Remembered {
    /// The way since the last reversal: `z' = (w - |w|*z)/h` with the distance `h`, rad.
    Way(fn(&[f64]) -> f64),
    /// The command as far as it could be followed: `z' = (u - z)*stiffness` with its greatest rate, V/s, and its stiffness, 1/s.
    Command(fn(&[f64]) -> [f64; 2]),
}

/// What a law gives, V referred to the winding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Given {
    /// As a torque on the shaft; dry friction is against the motion.
    pub torque: f64,
    /// As a voltage at the winding.
    pub voltage: f64,
}

/// A form with its parameters.
#[derive(Clone)]
pub struct OutsideLaw {
    form: &'static Outside,
    values: Vec<f64>,
}

/// Parts of an interval over which a law's mean is taken.
const PARTS: usize = 8;

impl Outside {
    /// The form of that name.
    pub fn find(name: &str) -> Option<&'static Outside> {
        Outside::ALL.iter().copied().find(|form| form.name == name)
    }

    /// The form with parameters that are typical on `machine`. The same seed gives the same bits.
    pub fn draw(&'static self, machine: &Machine, seed: u64) -> OutsideLaw {
        let values = (self.draw)(machine, &mut Chance::new(seed, self.name));
        OutsideLaw { form: self, values }
    }

    /// The form with these parameters, SI, in the order in which it states them; `None` where it has another number of them.
    pub fn with(&'static self, machine: &Machine, values: Vec<f64>) -> Option<OutsideLaw> {
        let drawn = self.draw(machine, 0);
        (drawn.values.len() == values.len()).then_some(OutsideLaw { form: self, values })
    }
}

impl OutsideLaw {
    /// Name of its form.
    pub fn name(&self) -> &'static str {
        self.form.name
    }

    /// What it depends on.
    pub fn depends_on(&self) -> &'static [Variable] {
        self.form.depends_on
    }

    /// Its parameters, SI, in the order in which its form states them.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What it gives to a turning motor; an inertia gives at a steady speed.
    pub fn given(&self, machine: &Machine, at: &At) -> Given {
        let sliding = Sliding {
            direction: at.speed.signum(),
            speed: at.speed.abs(),
            transmitted: (machine.kt_n_m_a * at.current).abs(),
            angle: at.angle,
            volts: at.volts,
        };
        let dry = if at.speed == 0.0 {
            0.0
        } else {
            sliding.direction * (self.form.friction)(&self.values, &sliding)
        };
        let [_, slope] = (self.form.inertia)(&self.values, at.angle);
        let heavier = 0.5 * slope * at.speed * at.speed;
        let torque = (self.form.torque)(&self.values, at) - dry - heavier;
        Given {
            torque: machine.winding_volts(torque),
            voltage: (self.form.volts)(&self.values, at),
        }
    }

    /// What it gives as a mean over the interval that begins at each sample of a run under voltage, by the interval's mean current: a
    /// command that jumps makes the current jump within the interval.
    pub fn along(&self, machine: &Machine, run: &Run) -> Vec<Given> {
        let time_constant = machine.inductance_h / machine.resistance_ohm;
        let (mut memory, mut current) = ([0.0; 2], 0.0);
        let last = run.counts.len().saturating_sub(1);
        (0..run.counts.len())
            .map(|k| {
                let next = (k + 1).min(last);
                let middle = |of: &[f64]| 0.5 * (of[k] + of[next]);
                let seconds = run.time_s[next] - run.time_s[k];
                let at = At {
                    angle: middle(&run.angle_rad),
                    speed: middle(&run.speed_rad_s),
                    current,
                    volts: run.voltage_v[k],
                    memory,
                };
                let volts = run.voltage_v[k] + self.given(machine, &at).voltage;
                let end = (volts - machine.kb_v_s_rad * at.speed) / machine.resistance_ohm;
                let parts = seconds / time_constant.max(1e-9);
                let left = current - end;
                let mean = if parts > 0.0 {
                    end - left * (-parts).exp_m1() / parts
                } else {
                    current
                };
                current = end + left * (-parts).exp();
                memory = self.remembered(&at, seconds);
                let remembered = memory[0] - at.memory[0];
                let gained = run.speed_rad_s[next] - run.speed_rad_s[k];
                let mut sum = Given::default();
                for part in 0..PARTS {
                    let x = (part as f64 + 0.5) / PARTS as f64;
                    let turned = (run.speed_rad_s[k] + 0.5 * gained * x) * seconds * x;
                    let at = At {
                        angle: run.angle_rad[k] + turned,
                        speed: run.speed_rad_s[k] + gained * x,
                        current: mean,
                        memory: [at.memory[0] + remembered * x, 0.0],
                        ..at
                    };
                    let given = self.given(machine, &at);
                    let [more, _] = (self.form.inertia)(&self.values, at.angle);
                    let faster = if seconds > 0.0 { gained / seconds } else { 0.0 };
                    sum.torque += given.torque - machine.winding_volts(more * faster);
                    sum.voltage += given.voltage;
                }
                Given {
                    torque: sum.torque / PARTS as f64,
                    voltage: sum.voltage / PARTS as f64,
                }
            })
            .collect()
    }

    /// Its memory after `dt` s as they are `at` the beginning, in closed form.
    pub fn remembered(&self, at: &At, dt: f64) -> [f64; 2] {
        let [memory, _] = at.memory;
        let now = match self.form.memory {
            None => 0.0,
            Some(Remembered::Way(_)) if at.speed == 0.0 => memory,
            Some(Remembered::Way(distance)) => {
                let kept = (-(at.speed * dt).abs() / distance(&self.values)).exp();
                at.speed.signum() + (memory - at.speed.signum()) * kept
            }
            Some(Remembered::Command(limits)) => {
                let [rate, stiffness] = limits(&self.values);
                let (missing, bend) = (at.volts - memory, rate / stiffness);
                // At the greatest rate up to the bend, and from there on ever slower.
                let full = ((missing.abs() - bend) / rate).clamp(0.0, dt);
                let left = missing - missing.signum() * rate * full;
                at.volts - left * (-stiffness * (dt - full)).exp()
            }
        };
        [now, 0.0]
    }
}

impl std::fmt::Debug for OutsideLaw {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {:?}", self.name(), self.values)
    }
}

impl Effect for OutsideLaw {
    fn volts(&self, volts: f64, at: &At) -> f64 {
        volts + (self.form.volts)(&self.values, at)
    }

    fn torque(&self, at: &At) -> f64 {
        (self.form.torque)(&self.values, at)
    }

    fn friction(&self, sliding: &Sliding) -> f64 {
        (self.form.friction)(&self.values, sliding)
    }

    fn inertia(&self, angle: f64) -> [f64; 2] {
        (self.form.inertia)(&self.values, angle)
    }

    fn memories(&self) -> usize {
        usize::from(self.form.memory.is_some())
    }

    fn memory_rates(&self, at: &At) -> [f64; 2] {
        let [memory, _] = at.memory;
        let rate = match self.form.memory {
            None => 0.0,
            Some(Remembered::Way(distance)) => {
                (at.speed - at.speed.abs() * memory) / distance(&self.values)
            }
            Some(Remembered::Command(limits)) => {
                let [rate, stiffness] = limits(&self.values);
                ((at.volts - memory) * stiffness).clamp(-rate, rate)
            }
        };
        [rate, 0.0]
    }

    fn stiffness_per_s(&self, at: &At) -> f64 {
        match self.form.memory {
            None => 0.0,
            Some(Remembered::Way(distance)) => at.speed.abs() / distance(&self.values),
            Some(Remembered::Command(limits)) => limits(&self.values)[1],
        }
    }

    fn piece(&self, at: &At, _transmitted: f64) -> i8 {
        let jump = self.form.jump_rad_s.map(|jump| jump(&self.values));
        i8::from(jump.is_some_and(|jump| at.speed.abs() > jump))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bench, DriveSample};

    fn drive(machine: &Machine) -> Vec<DriveSample> {
        let levels = [0.1, 0.5, -0.3, 1.0, -1.0, 0.0, -0.6];
        let volts = levels.iter().flat_map(|part| [part * machine.supply_v; 60]);
        let sample = |volts| DriveSample {
            volts,
            enabled: true,
        };
        volts.map(sample).collect()
    }

    #[test]
    fn every_form_acts_and_half_the_substep_gives_the_same_recording() {
        let machine = Machine::gearmotor();
        let drive = drive(&machine);
        let plain = Bench::new(machine).run(&drive).unwrap();
        for form in Outside::ALL {
            for seed in 0..3 {
                let mut bench = Bench::new(machine);
                bench.outside = Some(form.draw(&machine, seed));
                let run = bench.run(&drive).unwrap();
                bench.substep_hz *= 2.0;
                let finer = bench.run(&drive).unwrap();
                let gap = |other: &[f64]| {
                    let pairs = run.angle_rad.iter().zip(other);
                    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
                };
                assert!(gap(&plain.angle_rad) > 0.002, "{}", form.name);
                let refined = gap(&finer.angle_rad);
                assert!(refined < 1e-4, "{} {seed}: {refined}", form.name);
            }
        }
    }

    /// Along a steady speed the shaft takes what the truth says.
    #[test]
    fn the_truth_is_what_the_motor_is_short_of() {
        let machine = Machine::gearmotor();
        for form in Outside::ALL
            .iter()
            .filter(|form| !form.depends_on.contains(&Variable::Angle))
        {
            for level in [0.7, -0.9] {
                let law = form.draw(&machine, 1);
                let mut bench = Bench::new(machine);
                bench.outside = Some(law.clone());
                let volts = level * machine.supply_v;
                let sample = DriveSample {
                    volts,
                    enabled: true,
                };
                let run = bench.run(&[sample; 800]).unwrap();
                let memory = match form.memory {
                    Some(Remembered::Command(_)) => volts,
                    _ => level.signum(),
                };
                let at = At {
                    angle: 0.0,
                    speed: run.speed_rad_s[799],
                    current: run.current_a[799],
                    volts,
                    memory: [memory, 0.0],
                };
                let total = machine.kb_v_s_rad + machine.winding_volts(machine.viscous_n_m_s);
                let short = total * at.speed - volts;
                let given = law.given(&machine, &at);
                let truth = given.torque + given.voltage;
                assert!(
                    (truth - short).abs() < 1e-6,
                    "{}: {truth} {short}",
                    form.name
                );
            }
        }
    }
}
