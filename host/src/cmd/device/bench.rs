//! `servoid device bench`: the workbench with a device.

use super::super::bench::{resumed, serve};
use super::record::{open, order};
use crate::cli::DeviceBenchArgs;
use crate::device::Order;
use crate::error::Error;
use crate::session::Session;
use crate::workbench::{Device, Server};
use shared::wire::Kind;

pub(super) fn run(session: &Session, args: &DeviceBenchArgs) -> Result<(), Error> {
    let opening = resumed(args.session.as_deref())?;
    let bench = open(session, &args.port, &args.limits)?;
    let order = Order {
        coast: !args.no_coast,
        ..order(session, &bench.reached, &args.limits, Kind::Record)?
    };
    // What no run could be ordered with is said now, not when the motor is armed.
    order.job(&bench.about, &[])?;
    let device = Device::new(bench.reached, bench.about, order, args.runs.clone())?;
    let server = Server::open(opening, args.page_port, args.session.clone(), Some(device))?;
    serve(session, server, args.no_open)
}
