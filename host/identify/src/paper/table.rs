//! Table 1 of the paper, as printed.

use crate::fit::margins::{Loop, Margins};
use shared::motor::{Machine, Physical};

/// One column of the paper's Table 1.
#[derive(Clone, Copy, Debug)]
pub struct Printed {
    /// Method; `actual` for the true motor.
    pub algorithm: &'static str,
    /// Best cost, deg·s; none for the true motor.
    pub cost: Option<f64>,
    /// The six parameters, SI.
    pub physical: Physical<f64>,
    /// The margins as printed, one digit after the point.
    pub margins: Margins,
}

const fn printed(
    algorithm: &'static str,
    cost: Option<f64>,
    [inductance, resistance, kt, inertia, viscous, kb]: [f64; 6],
    gain_db: f64,
    phase_deg: f64,
) -> Printed {
    Printed {
        algorithm,
        cost,
        physical: Physical {
            resistance,
            inductance,
            kt,
            kb,
            inertia,
            viscous,
        },
        margins: Margins { gain_db, phase_deg },
    }
}

/// The columns of Table 1.
pub const PRINTED: [Printed; 4] = [
    printed(
        "actual",
        None,
        [0.02, 1.2, 0.06, 6.2e-4, 1e-4, 0.06],
        11.4,
        23.7,
    ),
    printed(
        "pso",
        Some(4.7092),
        [0.0001, 0.0001, 0.0111, 0.0221, 1.3621, 0.0498],
        11.8,
        24.0,
    ),
    printed(
        "ga",
        Some(42.8792),
        [0.0011, 0.2554, 1.5, 0.0727, 0.1949, 0.0289],
        23.3,
        29.2,
    ),
    printed(
        "firefly",
        Some(4.7148),
        [0.871_16, 1.4494, 1.182, 0.000_269_79, 0.016_418, 0.041_856],
        11.8,
        24.0,
    ),
];

impl Printed {
    /// The machine as its terminals show it.
    pub fn machine(&self) -> Machine<f64> {
        self.physical.machine()
    }

    /// The six parameters in the order of the table, which is that of the search.
    pub fn values(&self) -> [f64; 6] {
        let Physical {
            resistance,
            inductance,
            kt,
            kb,
            inertia,
            viscous,
        } = self.physical;
        [inductance, resistance, kt, inertia, viscous, kb]
    }

    /// The margins that follow from the printed parameters.
    pub fn computed_margins(&self) -> Option<Margins> {
        Loop::from(&self.machine()).margins()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_eight_margins_follow_from_the_printed_parameters_to_the_last_digit() {
        for column in &PRINTED {
            let computed = column.computed_margins().expect("a stable loop");
            for (what, ours, theirs) in [
                ("gain margin", computed.gain_db, column.margins.gain_db),
                ("phase margin", computed.phase_deg, column.margins.phase_deg),
            ] {
                let rounded = (ours * 10.0).round() / 10.0;
                assert!(
                    (rounded - theirs).abs() < 1e-9,
                    "{} {what}: {ours}, printed {theirs}",
                    column.algorithm
                );
            }
        }
    }
}
