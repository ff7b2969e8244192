//! The terms that are tried.

use super::term::{Load, Place, Speed, Term};
use core::f64::consts::TAU;
use servoid_engine::problem::Data;

/// Exponents from which the search for one starts.
const EXPONENTS: [f64; 6] = [0.25, 0.5, 1.5, 2.0, 3.0, 4.0];
/// Scales of the speed, parts of the fastest, and of the current, parts of the supply, likewise.
const SCALES: [f64; 6] = [0.02, 0.05, 0.1, 0.2, 0.4, 0.8];
/// Speeds at which a torque steps, parts of the fastest, likewise: nearer to each other, as one step tells little of another.
const STEPS: [f64; 10] = [0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.65, 0.8];
/// Distances of the state, rad.
const DISTANCES: [f64; 7] = [0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0];
/// Greatest rates of a drive, supplies by the second, and its time constants, s.
const RATES: [f64; 6] = [3.0, 10.0, 30.0, 100.0, 300.0, 1000.0];
const TIMES: [f64; 6] = [3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1];
/// Places of the revolution, and widths of what is there.
const PLACES: u32 = 16;
const WIDTHS: [f64; 3] = [0.05, 0.2, 0.8];
/// Most cycles in a revolution.
const ORDERS: u32 = 12;

/// Every term, for a recording's fastest speed and supply.
pub fn library(data: &Data) -> Vec<Term> {
    let fastest = two_digits(data.units.speed);
    let supply = two_digits(data.supply);
    let mut terms = by_speed(fastest);
    terms.extend(by_load(fastest, supply));
    terms.extend(by_angle(fastest, supply));
    terms.extend(by_place());
    terms.extend((1..=ORDERS).map(Term::inertia));
    terms.extend(by_state(fastest));
    terms.extend(by_command(supply));
    terms
}

/// Rounded to two digits.
pub fn two_digits(value: f64) -> f64 {
    let unit = libm::pow(
        10.0,
        libm::floor(libm::log10(value.abs().max(1e-300))) - 1.0,
    );
    (value / unit).round() * unit
}

/// The size of the speed.
fn size(reference: f64) -> Speed {
    Speed::Power {
        exponent: 1.0,
        odd: false,
        reference,
    }
}

fn decay(scale: f64, odd: bool) -> Speed {
    Speed::Decay { scale, odd }
}

fn by_speed(reference: f64) -> Vec<Term> {
    let mut speeds = vec![Speed::One, Speed::Sign];
    speeds.push(size(reference));
    for exponent in EXPONENTS {
        for odd in [true, false] {
            speeds.push(Speed::Power {
                exponent,
                odd,
                reference,
            });
        }
        for forward in [true, false] {
            speeds.push(Speed::OneSided {
                exponent,
                forward,
                reference,
            });
        }
    }
    for part in SCALES {
        let scale = part * reference;
        speeds.extend([
            decay(scale, true),
            decay(scale, false),
            Speed::Hump {
                exponent: 1.0,
                scale,
            },
            Speed::Eddy { scale },
            Speed::Saturating { scale },
            Speed::Bending { scale },
            Speed::Tanh { scale },
            Speed::Beyond { threshold: scale },
        ]);
    }
    speeds.extend(STEPS.map(|part| Speed::Above {
        threshold: part * reference,
    }));
    let terms = speeds.into_iter();
    terms.map(|speed| Term::torque(speed, Load::One)).collect()
}

fn by_load(reference: f64, supply: f64) -> Vec<Term> {
    let plain = Speed::Plain { reference };
    let power = |exponent: f64, odd: bool| Load::Power {
        exponent,
        odd,
        reference: supply,
    };
    let square = |odd| Speed::Power {
        exponent: 2.0,
        odd,
        reference,
    };
    let size = size(reference);
    let mut pairs = vec![
        (Speed::One, Load::Size),
        (Speed::Sign, Load::Plain),
        (Speed::Sign, Load::Size),
        (plain, Load::Plain),
        (plain, Load::Size),
        (size, Load::Plain),
        (square(true), Load::Size),
        (square(false), Load::Plain),
    ];
    for exponent in [0.5, 1.5, 2.0, 3.0] {
        pairs.extend([
            (Speed::One, power(exponent, true)),
            (Speed::One, power(exponent, false)),
            (Speed::Sign, power(exponent, false)),
        ]);
    }
    pairs.extend(SCALES.map(|part| {
        let scale = part * supply;
        (Speed::One, Load::Saturating { scale })
    }));
    pairs.extend(SCALES.into_iter().flat_map(|part| {
        let decay = |odd| decay(part * reference, odd);
        [(decay(true), Load::Size), (decay(false), Load::Plain)]
    }));
    let terms = pairs.into_iter();
    terms
        .map(|(speed, load)| Term::torque(speed, load))
        .collect()
}

fn by_angle(reference: f64, supply: f64) -> Vec<Term> {
    let square_of_load = Load::Power {
        exponent: 2.0,
        odd: false,
        reference: supply,
    };
    let square = |odd| Speed::Power {
        exponent: 2.0,
        odd,
        reference,
    };
    let size = size(reference);
    let plain = Speed::Plain { reference };
    let fading = |part: f64| decay(part * reference, false);
    let modulated = [
        (Speed::One, Load::One),
        (fading(0.05), Load::One),
        (fading(0.2), Load::One),
        (fading(0.8), Load::One),
        (Speed::Sign, Load::One),
        (plain, Load::One),
        (size, Load::One),
        (square(false), Load::One),
        (square(true), Load::One),
        (Speed::One, Load::Plain),
        (Speed::One, Load::Size),
        (Speed::One, square_of_load),
        (Speed::Sign, Load::Size),
    ];
    let orders = 1..=ORDERS;
    let each = |order| modulated.map(|(speed, load)| Term::torque(speed, load).by_angle(order));
    orders.flat_map(each).collect()
}

/// A friction or a torque at one place, by itself or by the current.
fn by_place() -> Vec<Term> {
    let places = (0..PLACES).map(|k| TAU * f64::from(k) / f64::from(PLACES));
    let widths = |place| WIDTHS.map(|width| (place, width));
    let kinds = |(place, width)| {
        let torques = [
            (Speed::Sign, Load::One),
            (Speed::One, Load::One),
            (Speed::Sign, Load::Size),
            (Speed::One, Load::Plain),
        ];
        torques.map(|(speed, load)| Term::torque(speed, load).at_place(place, width))
    };
    places.flat_map(widths).flat_map(kinds).collect()
}

fn by_state(reference: f64) -> Vec<Term> {
    let size = size(reference);
    let fading = decay(0.2 * reference, false);
    let kinds = [
        (Speed::One, Load::One, false),
        (Speed::One, Load::Size, false),
        (Speed::One, Load::Plain, true),
        (size, Load::One, false),
        (fading, Load::One, false),
    ];
    let each = |distance| {
        kinds.map(|(speed, load, squared)| Term::torque(speed, load).with_memory(distance, squared))
    };
    DISTANCES.into_iter().flat_map(each).collect()
}

fn by_command(reference: f64) -> Vec<Term> {
    let voltage = |load| Term {
        place: Place::Voltage,
        ..Term::torque(Speed::One, load)
    };
    let mut loads = vec![Load::Size];
    for exponent in [0.5, 1.5, 2.0, 3.0] {
        loads.extend([true, false].map(|odd| Load::Power {
            exponent,
            odd,
            reference,
        }));
    }
    let rates = RATES.map(|rate| Load::Slewed {
        rate: rate * reference,
    });
    let times = TIMES.map(|time| Load::Lagging { time });
    loads.extend(rates.into_iter().chain(times));
    loads.into_iter().map(voltage).collect()
}
