//! A law as text.

use super::term::{Load, Place, Speed, Term};
use core::f64::consts::PI;

/// Greatest amplitude, times the one that was found.
const MOST: f64 = 10.0;
/// Largest amplitude of an inertia from which a search starts, as a part of its mean.
const LARGEST_PART: f64 = 0.9;

/// Time in which a drive of limited rate ends at its command, s.
const BEND: f64 = 2e-4;

/// Parameters that are collected while a text grows.
struct Parameters {
    texts: Vec<String>,
    suffix: String,
}

impl Parameters {
    /// Adds one; its name.
    fn add(&mut self, name: &str, value: f64, low: f64, high: f64, unit: &str) -> String {
        let name = format!("{name}{}", self.suffix);
        let space = if unit.is_empty() { "" } else { " " };
        self.texts.push(format!(
            "{name} = {} in [{}, {}]{space}{unit}",
            number(value),
            number(low),
            number(high)
        ));
        name
    }

    /// Adds a number that shapes a term, which is searched for from a tenth of it to five times as much; its name.
    fn shape(&mut self, name: &str, value: f64, unit: &str) -> String {
        self.add(name, value, 0.1 * value, 5.0 * value, unit)
    }

    /// Adds a fixed number with a unit; its name.
    fn fix(&mut self, name: &str, value: f64, unit: &str) -> String {
        let name = format!("{name}{}", self.suffix);
        self.texts
            .push(format!("{name} = {} {unit}", number(value)));
        name
    }
}

/// Four digits.
fn number(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    let digits = 3 - libm::floor(libm::log10(value.abs())) as i32;
    if (-1..=7).contains(&digits) {
        let text = format!("{value:.*}", digits.max(0) as usize);
        if text.contains('.') {
            return text.trim_end_matches('0').trim_end_matches('.').to_owned();
        }
        return text;
    }
    let text = format!("{value:.3e}");
    match text.split_once('e') {
        Some((digits, power)) if digits.contains('.') => {
            let digits = digits.trim_end_matches('0').trim_end_matches('.');
            format!("{digits}e{power}")
        }
        _ => text,
    }
}

/// The text of terms.
pub fn formula(terms: &[Term], name: &str) -> String {
    let mut parameters = Parameters {
        texts: Vec::new(),
        suffix: String::new(),
    };
    // A budget stands against the motion, and is never negative.
    let dry = budget(terms);
    let place = match (terms.first().map(|term| term.place), dry) {
        (Some(Place::Voltage | Place::Drop), _) => "voltage",
        (Some(Place::Inertia), _) => "inertia",
        (_, true) => "friction",
        _ => "torque",
    };
    let mut expression = String::new();
    let mut state: Option<Vec<String>> = None;
    for (index, term) in terms.iter().enumerate() {
        parameters.suffix = if index == 0 {
            String::new()
        } else {
            (index + 1).to_string()
        };
        let (minus, text) = product(term, dry, &mut state, &mut parameters);
        match (expression.is_empty(), minus) {
            (true, true) => expression.push('-'),
            (true, false) => {}
            (false, true) => expression.push_str(" - "),
            (false, false) => expression.push_str(" + "),
        }
        expression.push_str(&text);
    }
    let mut parts = vec![format!("{name}: {place} = {expression}")];
    parts.extend(state.into_iter().flatten());
    parts.extend(parameters.texts);
    parts.join("; ")
}

/// Whether all terms together are a budget of dry friction.
fn budget(terms: &[Term]) -> bool {
    let constant: f64 = terms
        .iter()
        .filter(|term| term.order.is_none())
        .map(|term| -term.amplitudes[0])
        .sum();
    let waves: f64 = terms
        .iter()
        .filter(|term| term.order.is_some())
        .map(|term| libm::hypot(term.amplitudes[0], term.amplitudes[1]))
        .sum();
    let plain = |term: &Term| term.speed == Speed::Sign && term.load == Load::One;
    let against = |term: &Term| term.order.is_some() || term.amplitudes[0] < 0.0;
    terms.iter().all(|term| term.is_dry() && against(term))
        && (waves == 0.0 || (constant >= waves && terms.iter().all(plain)))
}

/// An inertia that the angle changes, above the least, which is the motor's own.
fn inertia(order: u32, [cosine, sine]: [f64; 2], parameters: &mut Parameters) -> String {
    let part = libm::hypot(cosine, sine).min(LARGEST_PART);
    let above = part / (1.0 - part);
    let a = parameters.add("a", above, 0.0, MOST * above, "");
    let phase = libm::atan2(sine, cosine);
    let f = parameters.add(
        "f",
        phase,
        -core::f64::consts::TAU,
        core::f64::consts::TAU,
        "rad",
    );
    format!("{a}*(1 + cos({} - {f}))", multiple(order))
}

/// A multiple of the angle.
fn multiple(order: u32) -> String {
    if order == 1 {
        return "theta".to_owned();
    }
    format!("{order}*theta")
}

/// A term without the sign before it, and whether that is a minus.
fn product(
    term: &Term,
    dry: bool,
    state: &mut Option<Vec<String>>,
    parameters: &mut Parameters,
) -> (bool, String) {
    if let (Place::Inertia, Some(order), [cosine, sine]) =
        (term.place, term.order, term.amplitudes.as_slice())
    {
        return (false, inertia(order, [*cosine, *sine], parameters));
    }
    let unit = match term.load {
        Load::One | Load::Power { .. } | Load::Saturating { .. } => "V",
        Load::Plain | Load::Size | Load::Slewed { .. } | Load::Lagging { .. } => "",
    };
    let mut minus = false;
    let mut factors = Vec::new();
    if let (Some(order), [cosine, sine]) = (term.order, term.amplitudes.as_slice()) {
        let turned = if dry { -1.0 } else { 1.0 };
        let most = MOST * libm::hypot(*cosine, *sine);
        let a = parameters.add("a", turned * cosine, -most, most, unit);
        let b = parameters.add("b", turned * sine, -most, most, unit);
        let angle = multiple(order);
        factors.push(format!("({a}*cos({angle}) + {b}*sin({angle}))"));
    } else {
        let amplitude = term.amplitudes.first().copied().unwrap_or_default();
        let size = amplitude.abs();
        minus = amplitude < 0.0 && !dry;
        factors.push(parameters.add("c", size, 0.0, MOST * size, unit));
    }
    speed(term.speed, dry, &mut factors, parameters);
    if let Some(bump) = term.bump {
        let (low, high) = (bump.place - PI, bump.place + PI);
        let f = parameters.add("f", bump.place, low, high, "rad");
        let h = parameters.shape("h", bump.width, "");
        factors.push(format!("exp((cos(theta - {f}) - 1)/{h})"));
    }
    load(term, &mut factors, state, parameters);
    if let Some(memory) = term.memory {
        if state.is_none() {
            let (low, high) = super::term::DISTANCES;
            let (low, high) = (low.min(memory.distance), high.max(memory.distance));
            let h = parameters.add("h", memory.distance, low, high, "rad");
            *state = Some(vec![format!("z' = (w - abs(w)*z)/{h}")]);
        }
        factors.push(if memory.squared { "z^2" } else { "z" }.to_owned());
    }
    (minus, factors.join("*"))
}

fn exponent(value: f64, parameters: &mut Parameters) -> String {
    let (low, high) = (value.min(0.1), value.max(4.0));
    parameters.add("p", value, low, high, "")
}

fn speed(speed: Speed, dry: bool, factors: &mut Vec<String>, parameters: &mut Parameters) {
    let scaled = |name: &str, value: f64, parameters: &mut Parameters| {
        parameters.shape(name, value, "rad/s")
    };
    let sign = |odd: bool, factors: &mut Vec<String>| {
        if odd && !dry {
            factors.push("sgn(w)".to_owned());
        }
    };
    match speed {
        Speed::One => {}
        Speed::Sign => sign(true, factors),
        Speed::Plain { reference } => {
            let reference = parameters.fix("v", reference, "rad/s");
            factors.push(format!("w/{reference}"));
        }
        Speed::Power {
            exponent: p,
            odd,
            reference,
        } => {
            sign(odd, factors);
            let p = exponent(p, parameters);
            let reference = parameters.fix("v", reference, "rad/s");
            factors.push(format!("abs(w/{reference})^{p}"));
        }
        Speed::Decay { scale, odd } => {
            sign(odd, factors);
            let scale = scaled("ws", scale, parameters);
            factors.push(format!("exp(-abs(w)/{scale})"));
        }
        Speed::Hump { exponent: p, scale } => {
            sign(true, factors);
            let p = exponent(p, parameters);
            let scale = scaled("ws", scale, parameters);
            factors.push(format!("abs(w/{scale})^{p}*exp(-abs(w)/{scale})"));
        }
        Speed::Eddy { scale } => {
            let scale = scaled("ws", scale, parameters);
            factors.push(format!("w/{scale}/(1 + (w/{scale})^2)"));
        }
        Speed::Saturating { scale } => {
            let scale = scaled("ws", scale, parameters);
            factors.push(format!("w/({scale} + abs(w))"));
        }
        Speed::Bending { scale } => {
            let scale = scaled("ws", scale, parameters);
            factors.push(format!("w/{scale}*abs(w)/({scale} + abs(w))"));
        }
        Speed::Tanh { scale } => {
            let scale = scaled("ws", scale, parameters);
            factors.push(format!("tanh(w/{scale})"));
        }
        Speed::OneSided {
            exponent: p,
            forward,
            reference,
        } => {
            let p = exponent(p, parameters);
            let ahead = if forward { "w" } else { "-w" };
            let reference = parameters.fix("v", reference, "rad/s");
            factors.push(format!("(max({ahead}, 0)/{reference})^{p}"));
        }
        Speed::Above { threshold } => {
            sign(true, factors);
            let threshold = scaled("w1", threshold, parameters);
            factors.push(format!("max(sgn(abs(w) - {threshold}), 0)"));
        }
        Speed::Beyond { threshold } => {
            sign(true, factors);
            let threshold = scaled("w1", threshold, parameters);
            factors.push(format!("max(abs(w)/{threshold} - 1, 0)"));
        }
    }
}

/// How far a drive is behind the command; the state is what it gives, far above any supply at most.
fn behind(rate: String, factors: &mut Vec<String>, state: &mut Option<Vec<String>>) {
    *state = Some(vec![
        format!("z' = {rate}"),
        "z in [-1000, 1000] V".to_owned(),
    ]);
    factors.push("(z - u)".to_owned());
}

fn load(
    term: &Term,
    factors: &mut Vec<String>,
    state: &mut Option<Vec<String>>,
    parameters: &mut Parameters,
) {
    let name = match term.place {
        Place::Torque | Place::Drop | Place::Inertia => "i",
        Place::Voltage => "u",
    };
    match term.load {
        Load::One => {}
        Load::Plain => factors.push(name.to_owned()),
        Load::Size => factors.push(format!("abs({name})")),
        Load::Saturating { scale } => {
            let scale = parameters.shape("es", scale, "V");
            factors.push(format!("{name}/({scale} + abs({name}))"));
        }
        Load::Slewed { rate } => {
            let r = parameters.shape("r", rate, "V/s");
            let bend = parameters.fix("s", BEND, "s");
            behind(
                format!("max(-{r}, min({r}, (u - z)/{bend}))"),
                factors,
                state,
            );
        }
        Load::Lagging { time } => {
            let s = parameters.shape("s", time, "s");
            behind(format!("(u - z)/{s}"), factors, state);
        }
        Load::Power {
            exponent: p,
            odd,
            reference,
        } => {
            if odd {
                factors.push(format!("sgn({name})"));
            }
            let p = parameters.add("q", p, p.min(0.1), p.max(4.0), "");
            let reference = parameters.fix("e", reference, "V");
            factors.push(format!("abs({name}/{reference})^{p}"));
        }
    }
}
