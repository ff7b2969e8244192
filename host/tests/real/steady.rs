//! Curves of steady speed against voltage.

use crate::limits::within;
use servoid_identify::diagnose::Verdict;
use servoid_identify::steady;
use servoid_io::input::SteadyCurve;
use shared::effects::Kind;
use testing::recordings::Vendored;

/// Known of these curves: a constant drop takes the error from 0.60 to 0.15 % and from 2.05 to 0.39 %.
#[test]
fn bam_mx_static_has_a_constant_drop_that_nothing_can_be_named_for() {
    let recordings = Vendored::new();
    for (file, drop_v, linear, left) in [("mx64", 0.110, 0.60, 0.15), ("mx106", 0.425, 2.05, 0.39)]
    {
        let path = recordings.unpack(&format!("bam_mx_static/{file}_noload_speed.csv"));
        let curve = SteadyCurve::read(&path).unwrap_or_else(|error| panic!("{error}"));
        let diagnosis = steady::fit_curve(&curve).unwrap_or_else(|error| panic!("{error}"));
        println!("{file}: {diagnosis:?}");
        let near = |value: f64| 0.8 * value..1.2 * value;
        within("drop", diagnosis.with_drop.drop_v, near(drop_v));
        within("linear", 100.0 * diagnosis.linear.relative, near(linear));
        within("rest", 100.0 * diagnosis.with_drop.relative, near(left));
        assert_eq!(diagnosis.verdict, Verdict::Inconclusive);
        for kind in [Kind::Coulomb, Kind::BrushDrop, Kind::DeadZone] {
            assert!(diagnosis.indistinguishable.contains(&kind), "{kind:?}");
        }
    }
}

/// Known of this driver: nothing turns below some 0.32 V, and the rest is strongly curved. No line, no drop, and none is claimed.
#[test]
fn un_dcmotor_has_a_driver_that_bends_its_curve() {
    let recordings = Vendored::new();
    let path = recordings.unpack("un_dcmotor/static_gain.csv");
    let curve = SteadyCurve::read(&path).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(curve.points.len(), 100);
    let diagnosis = steady::fit_curve(&curve).unwrap_or_else(|error| panic!("{error}"));
    println!("{diagnosis:?}");
    within("linear", 100.0 * diagnosis.linear.relative, 34.0..42.0);
    within("rest", 100.0 * diagnosis.with_drop.relative, 30.0..38.0);
    assert_eq!(diagnosis.verdict, Verdict::Unexplained);
}
