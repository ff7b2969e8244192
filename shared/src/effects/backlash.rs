//! A load behind a gap.

use super::{Contained, Coupling, Description, Effect, Facts, Parameter, Place, Starts, Value};
use crate::motor::Machine;
use crate::scalar::{Real, Scalar, lanes};
use crate::units::{PerUnit, Quantity};
use core::marker::PhantomData;

/// Part of the machine's inertia is a load that is driven only while the flanks of a gap touch; the
/// encoder sits on the motor. The flanks are a spring and a damper, given by the period of the two
/// inertias against each other while they touch. A share of the dry friction acts on the load: that of a gearbox, which holds the load while
/// the motor crosses the gap.
#[derive(Clone, Copy, Debug)]
pub struct Backlash<S>(PhantomData<S>);

lanes!(Backlash { 0 });

impl<S: Scalar> Effect<S> for Backlash<S> {
    const DESCRIPTION: Description = Description {
        name: "backlash",
        place: Place::Load,
        title: "backlash between motor and load",
        parameters: &[
            Parameter::amplitude("gap", Quantity::Angle, (0.0, 0.3), 0.06),
            Parameter::shape("load_share", Quantity::Ratio, (0.05, 0.95), 0.4),
            Parameter::shape("contact_period", Quantity::Time, (0.0005, 0.02), 0.002)
                .widening_to(0.2),
            Parameter::shape("contact_damping", Quantity::Ratio, (0.0, 1.5), 0.7),
            Parameter::friction_share("friction_share"),
        ],
        equation: "T = k*(twist -+ gap/2) + d*d(twist)/dt beyond the gap, never pulling; 0 within; friction_share of the dry friction is the load's",
        signature: "acceleration too high just after a reversal of the torque, then a knock",
        exposed_by: "square waves of small amplitude; multisines of several amplitudes",
        look_alikes: &["compliance", "delay", "lugre"],
        source: "Nordin, Gutman, Automatica 38(10), 2002",
        facts: Facts {
            // A gap that is closed. Its flanks are stiffer than many a shaft.
            contains: &[Contained {
                name: "compliance",
                values: &[Value::Own(2), Value::Own(1), Value::Own(3), Value::Own(4)],
                at_rest: &[(0, 1e-6)],
                whole: false,
            }],
            starts: Starts::Shares(&[(0, &[1.0, 0.4]), (1, &[1.0, 0.4, 1.75]), (2, &[1.0, 0.3])]),
            both_forms: true,
            series_parallel: false,
            ..Facts::PLAIN
        },
    };

    fn lower<R: Real>(_values: &[R], _units: &PerUnit<R>) -> Self {
        Backlash(PhantomData)
    }

    fn coupling<R: Real>(
        values: &[R],
        units: &PerUnit<R>,
        machine: &Machine<R>,
    ) -> Option<Coupling<R>> {
        // An angle of the coupling is counted in base speed × interval, like the travel.
        let half_gap = values[0] / (units.speed * units.interval) * R::from_f64(0.5);
        let period = units.lower(values[2], Quantity::Time);
        let (load_share, damping_ratio) = (values[1], values[3]);
        Some(Coupling {
            half_gap,
            friction_share: values[4],
            ..Coupling::new(load_share, machine.inertia, period, damping_ratio)
        })
    }
}
