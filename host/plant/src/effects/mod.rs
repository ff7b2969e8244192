//! The effects that the bench can hide in a motor: what an effect may touch, and the catalogue.

use super::bridge::Bridge;
use super::chance::Chance;
use super::coupling::Coupling;
use super::machine::Machine;

mod asym_coulomb;
mod asym_viscous;
mod backlash;
mod brush_drop;
mod cogging;
mod compliance;
mod coulomb;
mod dead_time;
mod dead_zone;
mod delay;
mod enc_ecc;
mod heating;
mod l_sat;
mod load_friction;
mod load_torque;
mod lugre;
mod missed_counts;
mod offset_voltage;
mod stribeck;
mod supply_sag;
mod torque_sat;
mod unbalance;
mod voltage_sat;
mod windage;

/// Every effect, in the order in which the signal meets them from the command to the counter. The
/// bench applies them in this order, whatever the order in which they were asked for.
pub static CATALOGUE: &[&Kind] = &[
    &delay::KIND,
    &offset_voltage::KIND,
    &dead_zone::KIND,
    &voltage_sat::KIND,
    &supply_sag::KIND,
    &dead_time::KIND,
    &brush_drop::KIND,
    &l_sat::KIND,
    &heating::KIND,
    &torque_sat::KIND,
    &cogging::KIND,
    &unbalance::KIND,
    &load_torque::KIND,
    &windage::KIND,
    &asym_viscous::KIND,
    &coulomb::KIND,
    &asym_coulomb::KIND,
    &stribeck::KIND,
    &lugre::KIND,
    &load_friction::KIND,
    &compliance::KIND,
    &backlash::KIND,
    &enc_ecc::KIND,
    &missed_counts::KIND,
];

/// One entry of the catalogue.
pub struct Kind {
    /// The name, as the contract spells it.
    pub name: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
    /// For an effect that acts on the armature voltage, and so vanishes behind a current loop: the voltage that it
    /// takes from an armature that is stalled, in closed form, from its parameters.
    pub electrical: Option<fn(&[f64], &Stall) -> f64>,
    /// Its parameters, in the order in which `build` takes them.
    pub params: &'static [Param],
    /// Other curves for the same physics.
    pub other_laws: &'static [Law],
    /// Makes the effect from its parameters, already scaled by the strength.
    pub build: fn(&[f64], &Machine) -> Box<dyn Effect>,
    /// Draws the parameters that give the effect its form rather than its size, by name, from their typical
    /// values on a machine; those that are not drawn stay typical.
    pub draw: fn(&[f64], &Machine, &mut dyn Random) -> Form,
    /// States the parameters of a model that is referred to the winding, in its documented order and units: a
    /// torque `T` is the voltage `T·R/Kt`, a current the voltage across the resistance. From the values of
    /// this effect's parameters, the machine and the encoder's counts per revolution.
    pub truth: fn(&[f64], &Machine, u32) -> Vec<f64>,
}

/// Another curve for the same physics, from another source, with the same parameters: a model that knows one curve
/// is judged by it, too.
pub struct Law {
    /// Its name in `effect:law=name`.
    pub name: &'static str,
    /// What differs, in a few words.
    pub about: &'static str,
    /// As [`Kind::build`].
    pub build: fn(&[f64], &Machine) -> Box<dyn Effect>,
    /// Where the model has a form that is this curve: the value of its last parameter, which is 0 for the effect's own
    /// curve. `None` where the model's form is never this curve.
    pub form: Option<f64>,
}

/// Values of some parameters, by name.
pub type Form = Vec<(&'static str, f64)>;

/// A stalled armature under a steady command.
#[derive(Clone, Copy, Debug)]
pub struct Stall {
    /// The command, V.
    pub command_v: f64,
    /// The machine's supply, V.
    pub supply_v: f64,
    /// The current that flows, A.
    pub current_a: f64,
}

/// A source of random numbers, which the caller seeds.
pub trait Random {
    /// Uniform from `low` to `high`.
    fn uniform(&mut self, low: f64, high: f64) -> f64;

    /// Uniform in the logarithm, from `low` to `high`, both above zero.
    fn log_uniform(&mut self, low: f64, high: f64) -> f64;

    /// True with the chance `part`.
    fn chance(&mut self, part: f64) -> bool;

    /// Plus or minus one.
    fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }
}

/// One physical parameter of an effect.
pub struct Param {
    /// Its name in `effect:name=value`.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// What it is, in a few words.
    pub about: &'static str,
    /// Whether the effect's strength multiplies it. At strength 0 the effect vanishes.
    pub scales: bool,
    /// Least and largest value that make sense.
    pub range: (f64, f64),
    /// A typical value on the given machine.
    pub typical: fn(&Machine) -> f64,
}

/// [`Kind::draw`] of an effect that has only a size, or a form that the model does not know.
fn only_its_size(_: &[f64], _: &Machine, _: &mut dyn Random) -> Form {
    Vec::new()
}

/// `A·sin(angle + φ)` as its parts of cosine and sine.
fn cosine_and_sine(amplitude: f64, phase: f64) -> [f64; 2] {
    [amplitude * phase.sin(), amplitude * phase.cos()]
}

impl Kind {
    /// The entry of that name.
    pub fn find(name: &str) -> Option<&'static Kind> {
        CATALOGUE.iter().copied().find(|kind| kind.name == name)
    }
}

/// What an effect sees of the motor at one instant.
#[derive(Clone, Copy, Debug)]
pub struct At {
    /// Angle of the motor shaft, rad.
    pub angle: f64,
    /// Speed of the motor shaft, rad/s.
    pub speed: f64,
    /// Armature current, A.
    pub current: f64,
    /// What the drive gives as the interval begins, V; in [`Effect::volts`] and [`Effect::memory_rates`] the voltage before the effect.
    pub volts: f64,
    /// The effect's own memory, in its own units.
    pub memory: [f64; 2],
}

/// What a friction sees of the shaft while it slides, or is about to.
#[derive(Clone, Copy, Debug)]
pub struct Sliding {
    /// Direction of the motion, or of the torque that would start it: +1 or −1.
    pub direction: f64,
    /// Magnitude of the speed, rad/s; 0 asks for the torque that holds the shaft.
    pub speed: f64,
    /// Torque passed from the motor to its load, N·m, ≥ 0.
    pub transmitted: f64,
    /// Angle of the motor shaft, rad.
    pub angle: f64,
    /// What the drive gives as the interval begins, V.
    pub volts: f64,
}

/// The winding's parameters at one instant; an effect multiplies what it changes.
#[derive(Clone, Copy, Debug)]
pub struct Winding {
    /// Armature resistance, Ω.
    pub resistance_ohm: f64,
    /// Incremental armature inductance, H.
    pub inductance_h: f64,
    /// Torque constant, N·m/A.
    pub kt_n_m_a: f64,
    /// Back-EMF constant, V·s/rad.
    pub kb_v_s_rad: f64,
}

/// A physical effect. Every hook does nothing unless overridden.
pub trait Effect: Send + Sync {
    /// Time by which the command reaches the bridge late, s.
    fn latency_s(&self) -> f64 {
        0.0
    }

    /// Voltage behind this effect, from the voltage before it.
    fn volts(&self, volts: f64, _at: &At) -> f64 {
        volts
    }

    /// The bridge that switches the armature, if this effect is one: it gives the voltage before the effect as its mean.
    fn bridge(&self) -> Option<Bridge> {
        None
    }

    /// Changes the winding's parameters.
    fn winding(&self, _winding: &mut Winding, _at: &At) {}

    /// Torque added to the shaft, N·m, positive forward.
    fn torque(&self, _at: &At) -> f64 {
        0.0
    }

    /// Budget of dry friction, N·m, ≥ 0: it opposes motion and holds a resting shaft.
    fn friction(&self, _sliding: &Sliding) -> f64 {
        0.0
    }

    /// Moment of inertia that the shaft carries at an angle beyond its own, kg·m², and by how much that grows by the radian. The
    /// machine's own is what it is at least.
    fn inertia(&self, _angle: f64) -> [f64; 2] {
        [0.0; 2]
    }

    /// The coupling to a second inertia, if this effect puts one on the shaft.
    fn coupling(&self) -> Option<Coupling> {
        None
    }

    /// How many numbers the effect remembers, at most two, which are zero at the start.
    fn memories(&self) -> usize {
        0
    }

    /// Rate of change of each, per s.
    fn memory_rates(&self, _at: &At) -> [f64; 2] {
        [0.0; 2]
    }

    /// Which smooth piece of the effect's law applies, −1, 0 or 1, also by the torque passed from the motor to its
    /// load, N·m, with its sign. A substep is cut where this changes, so that the integration never
    /// steps over a bend. Only an effect whose law has sharp bends needs it.
    fn piece(&self, _at: &At, _transmitted: f64) -> i8 {
        0
    }

    /// How fast the effect's own dynamics are, 1/s; the substep follows it.
    fn stiffness_per_s(&self, _at: &At) -> f64 {
        0.0
    }

    /// Angle that the encoder sees, rad, from the shaft's angle.
    fn sensed_angle(&self, angle: f64) -> f64 {
        angle
    }

    /// Counts lost during a sample of `dt` s at `speed` rad/s; positive when a forward count is lost.
    fn lost_counts(&self, _speed: f64, _dt: f64, _chance: &mut Chance) -> i64 {
        0
    }
}
