//! By which errors the workbench judges: those of a diagnosis of the same recordings, and the numbers of the fit that it shows.

use crate::source::{data, vendored};
use servoid_engine::problem::Data;
use servoid_identify::diagnose::{Budget, Criterion, search_catalogue};
use servoid_identify::fit::Options;
use servoid_identify::{Silent, identify_data};
use servoid_io::showcase;
use servoid_plant::Hidden;
use shared::effects::Kind;
use std::sync::atomic::AtomicBool;

/// Fitted and held out, and whether whole runs say little of them.
fn pairs() -> Vec<(Data, Data, bool)> {
    let friction = Hidden::typical("coulomb", &showcase::machine()).expect("an effect");
    let bench = |seed| {
        showcase::record(std::slice::from_ref(&friction), seed, "bench").expect("a recording")
    };
    // It turns one way only.
    let gearmotor = vendored("un_dcmotor/prbs_open");
    let (first, rest) = (gearmotor.split_at(0.7 * gearmotor.duration_s())).expect("two parts");
    vec![
        (data(&bench(1)), data(&bench(2)), false),
        (data(&first), data(&rest), true),
    ]
}

#[test]
fn models_are_fitted_and_judged_over_the_span_of_a_diagnosis() {
    let stop = AtomicBool::new(false);
    let options = Options::default();
    for (fitted, held_out, in_windows) in pairs() {
        let own = Criterion::of(&fitted, &held_out, &options, &Budget::usual(&stop));
        let found = search_catalogue(&fitted, &held_out, &options, &Budget::usual(&stop), &|| ());
        let found = found.expect("a diagnosis");
        assert_eq!(own.span, found.span, "{}", fitted.source);
        assert_eq!(own.span.window_s.is_some(), in_windows, "{:?}", own.span);
        let asked = Options {
            effects: vec![Kind::Coulomb],
            window_s: own.span.window_s,
            ..Options::default()
        };
        let fit =
            identify_data(&fitted, Some(&held_out), &asked, &Silent::default()).expect("a fit");
        let errors = own.errors(&fitted, &held_out, &fit).expect("errors");
        let shown = match fit.windowed.filter(|_| in_windows) {
            Some(windowed) => windowed.rms_counts,
            None => fit.rms_counts,
        };
        assert!(
            (errors.fitted / shown - 1.0).abs() < 1e-9,
            "{} is shown, {shown} is what the fit says",
            errors.fitted
        );
        let residual = own
            .residual(&fitted, &fit.candidate, fit.method)
            .expect("a residual");
        let square = residual.iter().map(|e| e * e).sum::<f64>() / residual.len() as f64;
        assert!(
            (square.sqrt() / errors.fitted - 1.0).abs() < 0.02,
            "{} is drawn, {} is said",
            square.sqrt(),
            errors.fitted
        );
        assert!(errors.held_out.is_finite() && errors.floor > 0.0);
    }
}
