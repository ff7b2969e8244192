//! Opens a device: a real one, or an emulated one.

use super::super::simulate::bench_of;
use crate::cli::{EmulateArgs, EmulationArgs, LimitArgs, PortArgs};
use crate::device::{DeviceError, Emulation, Image, Port, Reached};
use crate::error::Error;
use crate::session::Session;
use std::path::PathBuf;
use std::sync::atomic::Ordering;
use std::time::Duration;

/// Counts of an emulated encoder.
pub(super) const COUNTS_PER_REV: u32 = 2000;

/// Where `scripts/emulated` puts its images, the microcontroller's first.
const BUILT: [&str; 2] = [
    "target/mcu/thumbv7em-none-eabihf/firmware/emulated",
    "target/firmware/emulated",
];

fn image(args: &EmulationArgs) -> Result<Image, Error> {
    let path = match &args.image {
        Some(path) => path.clone(),
        None => {
            let built = BUILT.iter().map(PathBuf::from).find(|path| path.exists());
            built.ok_or_else(|| {
                DeviceError::Emulation(
                    "no image of the firmware here: run `scripts/emulated` in the project's folder, which builds it, or give \
                     --image FILE"
                        .to_owned(),
                )
            })?
        }
    };
    Ok(Image::at(&path)?)
}

fn start(args: &EmulationArgs, counts_per_rev: u32, seed: u64) -> Result<(Emulation, f64), Error> {
    if !(args.pace > 0.0 && args.pace.is_finite()) {
        return Err(Error::Usage(format!(
            "--pace {}: must be above zero",
            args.pace
        )));
    }
    let bench = bench_of(&args.machine, &args.hide, counts_per_rev, seed)?;
    let supply_v = bench.machine.supply_v;
    let emulation = Emulation::start(&image(args)?, bench, args.pace)?;
    Ok((emulation, supply_v))
}

/// The device of `--port`, or an emulated one.
pub(super) fn reach(
    args: &PortArgs,
    limits: Option<&LimitArgs>,
    seed: u64,
) -> Result<Reached, Error> {
    if let Some(address) = &args.port {
        return Ok(Reached::at(Port::parse(address)?));
    }
    let counts = limits
        .and_then(|limits| limits.counts_per_rev)
        .unwrap_or(COUNTS_PER_REV);
    let (emulation, supply) = start(&args.emulation, counts, seed)?;
    Ok(Reached::emulated(emulation, supply, counts))
}

/// `servoid device emulate`.
pub(super) fn run(session: &Session, args: &EmulateArgs) -> Result<(), Error> {
    let (mut emulation, supply) = start(&args.emulation, args.counts_per_rev, session.seed)?;
    let text = format!(
        "an emulated device answers at {port}: --supply-v {supply} --counts-per-rev {}\n  servoid device info --port {port}\n\
         Ctrl-C ends it.\n",
        args.counts_per_rev,
        port = emulation.port()
    );
    session.deliver(
        &text,
        &serde_json::json!({ "schema": "servoid.emulation/1", "port": emulation.port().to_string(),
            "supply_v": supply, "counts_per_rev": args.counts_per_rev }),
    )?;
    while !session.stop().load(Ordering::Relaxed) {
        if !emulation.runs() {
            return Err(
                DeviceError::Emulation("the emulated device ended by itself".to_owned()).into(),
            );
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    Ok(())
}
