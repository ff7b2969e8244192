//! Demonstrations: a motor with Coulomb friction and cogging, and motors in which something is hidden.

use super::loaded::{Loaded, Source};
use super::recordings::Recordings;
use super::state::Secret;
use crate::error::Error;
use crate::prove::surprise;
use servoid_io::showcase;
use servoid_plant::Hidden;
use std::sync::Arc;

/// The two recordings of a seed's motor, and what is hidden in it.
pub(super) fn demonstration(seed: u64) -> Result<(Recordings, Secret), Error> {
    let hidden = surprise(&showcase::machine(), seed)?;
    let one = std::slice::from_ref(&hidden);
    let first = recorded(one, seed, &format!("blind demo {seed}"))?;
    let second = recorded(one, seed.wrapping_add(1), "its second recording")?;
    let recordings = Recordings::new(first, Some(second));
    let secret = Secret {
        hidden,
        seed,
        revealed: false,
    };
    Ok((recordings, secret))
}

/// The two recordings of a motor with friction and magnets that hold, as in the picture of the README.
pub(super) fn story() -> Result<Recordings, Error> {
    let machine = showcase::machine();
    let hidden = ["coulomb", "cogging"].map(|name| Hidden::typical(name, &machine));
    let hidden: Vec<Hidden> = hidden.into_iter().collect::<Result<_, _>>()?;
    let first = recorded(&hidden, 1, "demo motor")?;
    let second = recorded(&hidden, 2, "its second recording")?;
    Ok(Recordings::new(first, Some(second)))
}

/// As it would come from a user, so that it is kept and opened again as a user's.
pub(super) fn recorded(hidden: &[Hidden], seed: u64, name: &str) -> Result<Arc<Loaded>, Error> {
    let recording = showcase::record(hidden, seed, name)?;
    let mut csv = "t_s,voltage_v,angle_counts\n".to_owned();
    for k in 0..recording.len() {
        csv += &format!(
            "{},{},{}\n",
            recording.time_s[k], recording.command[k], recording.counts[k]
        );
    }
    Ok(Arc::new(Loaded::read(vec![Source {
        name: name.to_owned(),
        csv,
        motor: format!(
            "counts_per_rev = {}\nsupply_v = {:?}\n",
            showcase::COUNTS_PER_REV,
            showcase::machine().supply_v
        ),
        span_s: None,
    }])?))
}
