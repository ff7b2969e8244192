//! Which terms a model has.

/// Terms beside inertia and back-EMF with viscous friction, which every model has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terms {
    /// Coulomb friction, V.
    pub coulomb: bool,
    /// Voltage offset of the drive, V.
    pub offset: bool,
    /// Delay from command to drive, s.
    pub delay: bool,
    /// Viscous friction that differs between the directions, V·s/rad.
    pub asymmetric_viscous: bool,
    /// Gravity on an eccentric mass, V by sine and cosine of the angle.
    pub gravity: bool,
}

impl Terms {
    /// The linear motor.
    pub const LINEAR: Terms = Terms {
        coulomb: false,
        offset: false,
        delay: false,
        asymmetric_viscous: false,
        gravity: false,
    };

    /// Coulomb friction, offset and delay: what nearly every drive has.
    pub const USUAL: Terms = Terms {
        coulomb: true,
        offset: true,
        delay: true,
        ..Terms::LINEAR
    };

    /// Every combination of Coulomb friction, offset and delay, the linear motor first.
    pub fn combinations() -> Vec<Terms> {
        (0..8)
            .map(|bits| Terms {
                coulomb: bits & 1 != 0,
                offset: bits & 2 != 0,
                delay: bits & 4 != 0,
                ..Terms::LINEAR
            })
            .collect()
    }
}

/// Whether several recordings share their delay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Delays {
    /// One delay for all.
    Common,
    /// A delay for each: logs are shifted against each other by some ms.
    #[default]
    Each,
}
