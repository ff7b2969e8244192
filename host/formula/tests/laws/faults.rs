//! What a text is taken for, and what is said of one that is no law.

use servoid_formula::define;

#[test]
fn amplitudes_are_found() {
    for (text, expected) in [
        (
            "gear: z' = (w - abs(w)*z)/h; torque = -(ma*abs(tau)*z + md*tau^2/v0*z); h = 0.01 in [1e-3, 1] rad; ma, md in [0, 1]; v0 = 1 V",
            vec![false, true, true],
        ),
        (
            "p: torque = -c*sgn(w)*abs(w/w0)^p; c in [0, 1] V; p in [0.1, 3]; w0 = 100 rad/s",
            vec![true, false],
        ),
        (
            "k: torque = -c*(1 + k*cos(theta)); c in [0, 1] V; k in [0, 2]",
            vec![true, false],
        ),
        (
            "s: torque_constant = 1 - k*(i/v0)^2; k in [0, 1]; v0 = 12 V",
            vec![true],
        ),
    ] {
        let kind = define(text).unwrap_or_else(|fault| panic!("{fault}"));
        let found: Vec<bool> = kind.parameters().iter().map(|p| p.amplitude).collect();
        assert_eq!(found, expected, "{text}");
    }
}

#[test]
fn faults_point_at_the_character_and_say_what_was_expected() {
    for (text, at, words) in [
        ("torque = 1", 7, "`:`"),
        ("a: torque = c*w; c in [0, 1] V*s", 12, "expected V"),
        (
            "a: power = c*w; c in [0, 1] V",
            11,
            "laws belong to torque, friction,",
        ),
        (
            "a: x' = w; y' = w; z' = w; torque = c*y; c in [0, 1] V",
            19,
            "at most 2 states",
        ),
        (
            "a: x' = w; x' = w; torque = c*x; c in [0, 1] V",
            11,
            "a name already",
        ),
        ("a: torque = c*x; c in [0, 1] V", 14, "`x` is neither"),
        ("a: torque = c*(w; c in [0, 1] V", 16, "`)`"),
        ("a: torque = c*; c in [0, 1] V", 14, "a name"),
        ("a: torque = c; c in [1, 0] V", 15, "empty"),
        ("a: torque = c; c in [0, 1] N", 27, "no unit"),
        ("a: c in [0, 1] V", 16, "no place"),
        (
            "a: torque = c/w*w0; c in [0, 1] V; w0 = 1 rad/s",
            14,
            "zero",
        ),
        (
            "a: torque = c*(w/w0)^0.5; c in [0, 1] V; w0 = 1 rad/s",
            14,
            "negative",
        ),
        ("a: angle = c*u/u0; c in [0, 1] rad; u0 = 1 V", 13, "theta"),
        (
            "a: torque = c*temperature; c in [0, 1] V",
            12,
            "expected V, found V*degC",
        ),
        (
            "a: inertia = c*temperature; c in [0, 1] 1/degC",
            15,
            "theta alone",
        ),
        ("a: voltage = c*tau; c in [0, 1]", 15, "depends on"),
        (
            "a: z' = (u - z)/s; voltage = z; s in [1, 2] s",
            29,
            "expected V, found 1",
        ),
        (
            "a: z' = u/s; voltage = c*z; c in [0, 1] V/rad; s in [1, 2] s; z in [-1, 1] rad",
            8,
            "expected rad/s",
        ),
        (
            "a: z' = w; friction = z; z in [0, 1] V",
            8,
            "a state belongs to",
        ),
        ("coulomb: torque = c; c in [0, 1] V", 0, "catalogue"),
        ("a: torque = c + w; c in [0, 1] V", 16, "added"),
        ("", 0, "a name"),
    ] {
        let fault = define(text).expect_err(text);
        assert_eq!(fault.at, at, "{text}: {fault}");
        assert!(fault.what.contains(words), "{text}: {fault}");
    }
}
