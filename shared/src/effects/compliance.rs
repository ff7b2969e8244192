//! A load behind a spring.

use super::{Coupling, Description, Effect, Facts, Other, Parameter, Place, Starts, ToldFrom};
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};
use core::marker::PhantomData;

/// Part of the machine's inertia is a load on an elastic shaft; the encoder sits on the motor. The
/// spring is given by the period of the two inertias against each other, `2π·√(Jm·Jl/(J·k))`: at zero
/// it is rigid. A share of the dry friction acts on the load.
#[derive(Clone, Copy, Debug)]
pub struct Compliance<S>(PhantomData<S>);

lanes!(Compliance { 0 });

impl<S: Scalar> Effect<S> for Compliance<S> {
    const DESCRIPTION: Description = Description {
        name: "compliance",
        place: Place::Load,
        title: "elastic shaft between motor and load",
        parameters: &[
            Parameter::amplitude("period", Quantity::Time, (0.0, 0.1), 0.033).widening_to(1.0),
            Parameter::shape("load_share", Quantity::Ratio, (0.05, 0.95), 0.4),
            Parameter::shape("damping_ratio", Quantity::Ratio, (0.0, 1.0), 0.05),
            Parameter::friction_share("friction_share"),
        ],
        equation: "T = k*twist + d*d(twist)/dt on the motor and against the load; friction_share of the dry friction is the load's",
        signature: "ringing after steps; a notch and a peak in the frequency response",
        exposed_by: "a chirp, multisine",
        look_alikes: &["backlash", "delay", "lugre"],
        source: "Ellis, Control System Design Guide, 2012, ch. 16",
        facts: Facts {
            starts: Starts::Shares(&[(0, &[1.0, 2.0, 0.5, 0.25]), (1, &[1.0, 0.4, 1.75])]),
            series_parallel: false,
            told_from: &[
                ToldFrom {
                    other: Other::Effect("backlash"),
                    record: "multisines of several amplitudes: the resonance moves with the amplitude for a gap, not for a spring",
                    measure: None,
                },
                ToldFrom {
                    other: Other::Effect("delay"),
                    record: "a chirp: the phase of a delay falls evenly with the frequency, a resonance steps by half a turn",
                    measure: None,
                },
            ],
            ..Facts::PLAIN
        },
    };

    fn lower<R: Real>(_values: &[R], _units: &PerUnit<R>) -> Self {
        Compliance(PhantomData)
    }

    fn coupling<R: Real>(
        values: &[R],
        units: &PerUnit<R>,
        machine: &Machine<R>,
    ) -> Option<Coupling<R>> {
        let period = units.lower(values[0], Quantity::Time);
        let (load_share, damping_ratio) = (values[1], values[2]);
        Some(Coupling {
            friction_share: values[3],
            ..Coupling::new(load_share, machine.inertia, period, damping_ratio)
        })
    }
}
