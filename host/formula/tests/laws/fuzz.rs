//! Random texts: laws give what was written, and none makes the parser panic.

use super::plan;
use proptest::prelude::*;
use servoid_formula::{Point, define, law_of};
use shared::effects::formula::Output;
use testing::length::fuzzed;

/// A random expression of the speed, the current and the angle that is of no unit.
fn expression() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        (0.05..3.0f64).prop_map(|x| format!("{x:.3}")),
        Just("(w/w0)".to_owned()),
        Just("(i/v0)".to_owned()),
        Just("sin(theta)".to_owned()),
        Just("c".to_owned()),
    ];
    leaf.prop_recursive(4, 24, 2, |inner| {
        let two = (inner.clone(), inner.clone());
        prop_oneof![
            two.clone().prop_map(|(a, b)| format!("({a} + {b})")),
            two.clone().prop_map(|(a, b)| format!("({a} - {b})")),
            two.clone().prop_map(|(a, b)| format!("{a}*{b}")),
            two.clone().prop_map(|(a, b)| format!("{a}/(1 + abs({b}))")),
            two.clone().prop_map(|(a, b)| format!("min({a}, {b})")),
            two.prop_map(|(a, b)| format!("max({a}, -{b})")),
            inner.clone().prop_map(|a| format!("tanh({a})")),
            inner.clone().prop_map(|a| format!("exp(-abs({a}))")),
            inner.clone().prop_map(|a| format!("abs({a})^0.7")),
            inner.clone().prop_map(|a| format!("({a})^2")),
            // Of a difference that is nothing, the sign would be that of a rounding.
            prop::sample::select(&["w", "i", "sin(theta)"][..]).prop_map(|a| format!("sgn({a})")),
            inner.prop_map(|a| format!("cos({a})")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, ..ProptestConfig::default() })]

    /// A friction budget shows the law's value at once: with a shaft that is at rest or moves slowly no other part of the model
    /// matters. Here the compiled law is compared with the text's own value by way of a torque on a motor at known motion.
    #[test]
    fn what_runs_is_what_was_written(text in expression(), c in 0.1..1.0f64, seed in 0u64..1000) {
        let text = format!("t{seed}: torque = v0*({text}); c = 0.5 in [-2, 2]; w0 = 400 rad/s; v0 = 12 V");
        let Ok(kind) = define(&text) else { return Ok(()) };
        let law = law_of(kind).unwrap();
        prop_assert_eq!(law.definition.output, Output::Torque);
        for k in 0..20 {
            let point = Point {
                speed: 700.0 * ((k as f64 * 0.618).fract() * 2.0 - 1.0),
                angle: std::f64::consts::TAU * (k as f64 * 0.754).fract(),
                current: 20.0 * ((k as f64 * 0.569).fract() * 2.0 - 1.0),
                ..Point::default()
            };
            let written = law.definition.value(&[c], &point);
            let runs = law.formula.value(&[c], &plan(&[]).units, [point.speed, point.angle, point.current]);
            let size = 1.0 + written.abs();
            // Beyond 7 the hyperbolic tangent is one, which it is to 2e-6.
            prop_assert!((written - runs).abs() < 2e-6 * size || !written.is_finite(), "{}: {written} as written, {runs} as it runs at {point:?}", text);
        }
    }
}

/// Words of laws.
const WORDS: [&str; 38] = [
    "a",
    ":",
    ";",
    "torque",
    "=",
    "(",
    ")",
    "w",
    "z",
    "'",
    "in",
    "[",
    "]",
    ",",
    "1",
    "-",
    "+",
    "*",
    "/",
    "^",
    "abs",
    "exp",
    "sgn",
    "V",
    "rad",
    "1e-3",
    "c",
    "i",
    "friction",
    "max",
    " ",
    "voltage",
    "u",
    "theta",
    "s",
    "v",
    "temperature",
    "degC",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: fuzzed(300), ..ProptestConfig::default() })]

    #[test]
    fn no_text_panics(text in "\\PC{0,200}") {
        let _ = define(&text);
    }

    #[test]
    fn no_text_of_its_own_words_panics(words in prop::collection::vec(prop::sample::select(&WORDS[..]), 0..60)) {
        let _ = define(&format!("a: torque = {}", words.concat()));
        let _ = define(&words.concat());
    }

    /// Texts that are laws but for one place: most of them pass the grammar.
    #[test]
    fn no_law_with_a_fault_panics(which in 0..LAWS.len(), at in 0usize..200, gone in 0usize..4, word in prop::sample::select(&WORDS[..])) {
        let mut text: Vec<char> = LAWS[which].chars().collect();
        let from = at.min(text.len());
        let to = (from + gone).min(text.len());
        text.splice(from..to, word.chars());
        let _ = define(&text.into_iter().collect::<String>());
    }
}

/// Laws that are spoilt.
const LAWS: [&str; 6] = [
    "mass: x' = w - y; y' = k*x; torque = -c*x; c in [0, 100] V/rad; k in [1, 1e6] 1/s^2; x in [-1, 1] rad; y in [-9, 9] rad/s",
    "gear: z' = (w - abs(w)*z)/h; torque = -(ma*abs(tau)*z + md*tau^2/v0*z); h = 0.01 in [1e-3, 1] rad; ma, md in [0, 1]; v0 = 1 V",
    "p: friction = c*abs(w/w0)^p*exp(-abs(w)/w0); c in [0, 1] V; p in [0.1, 3]; w0 = 100 rad/s",
    "slew: z' = max(-r, min(r, (u - z)/s)); voltage = z - u; r in [1, 1e5] V/s; s = 5e-4 s; z in [-24, 24] V",
    "crank: inertia = a*(1 + cos(2*theta - f)); a in [0, 4]; f in [-6.3, 6.3] rad",
    "s: torque_constant = 1 - k*(i/v0)^2*tanh(t/s); k in [0, 1]; v0 = 12 V; s in [1, 9] s",
];
