//! The channels of a log.

/// A quantity of which a log may have a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Time of the row.
    Time,
    /// The command: what the drive was told.
    Command,
    /// The encoder's reading, an angle, or a speed in its place.
    Angle,
    /// A number that is measured beside the angle.
    Measured(Measured),
    /// Whether the bridge drives the motor.
    Enabled,
    /// The direction of a command that has no sign.
    Direction,
}

/// A number that is measured beside the angle, one a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Measured {
    /// Armature current, A.
    Current,
    /// Temperature of the motor, °C.
    Temperature,
    /// Supply voltage of the bridge, V.
    Supply,
}

impl Channel {
    /// Every channel, in the order in which people read them.
    pub const ALL: [Channel; 8] = [
        Channel::Time,
        Channel::Command,
        Channel::Angle,
        Channel::Measured(Measured::Current),
        Channel::Measured(Measured::Temperature),
        Channel::Measured(Measured::Supply),
        Channel::Enabled,
        Channel::Direction,
    ];

    /// The channel with this key in a file of a voltage or current drive.
    pub fn by_key(key: &str) -> Option<Self> {
        let mut all = Channel::ALL.into_iter();
        all.find(|channel| channel.facts().key == key)
    }
}

impl Measured {
    /// How many there are.
    pub const COUNT: usize = 3;
    /// Every one, in the order in which recordings are written.
    pub const ALL: [Measured; Measured::COUNT] =
        [Measured::Current, Measured::Temperature, Measured::Supply];

    /// Its place in lists of one value a measured channel.
    pub(crate) fn place(self) -> usize {
        self as usize
    }
}
