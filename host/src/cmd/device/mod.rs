//! `servoid device`: talks to the firmware.

mod bench;
mod emulate;
mod record;
mod verify;

use crate::cli::{DeviceArgs, DeviceVerb, OnDevice};
use crate::device::{Conversation, serial_ports};
use crate::error::Error;
use crate::session::Session;
use serde::Serialize;
use shared::wire::{About, Format, Kind, ServoState, ToDevice};

pub(super) fn run(session: &Session, args: &DeviceArgs) -> Result<(), Error> {
    match &args.verb {
        DeviceVerb::List => list(session),
        DeviceVerb::Info(args) => info(session, args),
        DeviceVerb::Commission(args) => record::commission(session, args, Kind::Commission),
        DeviceVerb::Tune(args) => record::commission(session, args, Kind::Tune),
        DeviceVerb::Follow(args) => record::follow(session, args),
        DeviceVerb::Record(args) => record::record(session, args),
        DeviceVerb::Stream(args) => record::stream(session, args),
        DeviceVerb::Run(args) => record::play(session, args),
        DeviceVerb::Verify(args) => verify::run(session, args),
        DeviceVerb::Bench(args) => bench::run(session, args),
        DeviceVerb::Stop(args) => stop(session, args),
        DeviceVerb::Emulate(args) => emulate::run(session, args),
    }
}

#[derive(Serialize)]
struct Ports {
    schema: &'static str,
    ports: Vec<PortJson>,
}

#[derive(Serialize)]
struct PortJson {
    port: String,
    what: String,
}

fn list(session: &Session) -> Result<(), Error> {
    let ports: Vec<PortJson> = serial_ports()?
        .into_iter()
        .map(|(port, what)| PortJson { port, what })
        .collect();
    let mut text: String = ports
        .iter()
        .map(|found| format!("{}  {}\n", found.port, found.what))
        .collect();
    if ports.is_empty() {
        text = "no serial ports; plug the device in, or try one without hardware: servoid device commission --emulate\n"
            .to_owned();
    }
    session.deliver(
        &text,
        &Ports {
            schema: "servoid.ports/1",
            ports,
        },
    )
}

#[derive(Serialize)]
struct AboutJson<'a> {
    schema: &'static str,
    board: &'a str,
    firmware: &'a str,
    link_version: u16,
    period_s: f64,
    capacity: u16,
    format: &'static str,
    senses_current: bool,
    senses_supply: bool,
    /// Current that the bridge bears, A; null if it protects itself.
    current_limit_a: Option<f64>,
    /// How long its encoder's readings are late, s.
    encoder_latency_s: f64,
    /// Its servo: `none`, `untried` since the last power-up, or `tried`.
    servo: &'static str,
    /// Whether it keeps a servo over a power cut.
    keeps_servo: bool,
    /// What made the device start.
    reset: String,
    stage: String,
}

fn info(session: &Session, args: &OnDevice) -> Result<(), Error> {
    let device = emulate::reach(&args.port, None, session.seed)?;
    let mut conversation = Conversation::open(&device.port)?;
    let about = conversation.about()?;
    let details = conversation.details()?;
    let format = match about.format {
        Format::F32 => "f32",
        Format::Fixed => "fixed point",
    };
    let stage = format!("{:?}", about.stage).to_lowercase();
    let (servo, about_servo) = match (details.servo, details.keeps_servo) {
        (ServoState::None, true) => ("none", "not tuned; a servo is kept in its flash"),
        (ServoState::None, false) => ("none", "not tuned; a servo is kept until the power is cut"),
        (ServoState::Untried, _) => (
            "untried",
            "tuned before the last power-up: the motor is tried before it follows",
        ),
        (ServoState::Tried, true) => ("tried", "tuned; the servo is kept in its flash"),
        (ServoState::Tried, false) => ("tried", "tuned; the servo is kept until the power is cut"),
    };
    let period_s = f64::from(about.period_us) * 1e-6;
    let text = format!(
        "{}, firmware {}, {stage}\n  control period {} ms; fits up to {} periods ({:.2} s) in {format}\n  {}\n  {}\n  last start: {}\n",
        about.board,
        about.firmware,
        period_s * 1e3,
        about.capacity,
        f64::from(about.capacity) * period_s,
        match (about.senses_current, details.senses_supply) {
            (true, true) => "measures the current and the supply",
            (true, false) => "measures the current, not the supply",
            (false, true) => "measures the supply, not the current",
            (false, false) => "no sensor of current or supply",
        },
        about_servo,
        details.reset
    );
    let limit_a = f64::from(details.current_limit_ma) * 1e-3;
    let json = AboutJson {
        schema: "servoid.about/1",
        board: &about.board,
        firmware: &about.firmware,
        link_version: about.version,
        period_s,
        capacity: about.capacity,
        format,
        senses_current: about.senses_current,
        senses_supply: details.senses_supply,
        current_limit_a: Some(limit_a).filter(|limit| *limit > 0.0),
        encoder_latency_s: f64::from(details.encoder_latency_us) * 1e-6,
        servo,
        keeps_servo: details.keeps_servo,
        reset: details.reset.to_string(),
        stage,
    };
    session.deliver(&text, &json)
}

fn stop(session: &Session, args: &OnDevice) -> Result<(), Error> {
    let device = emulate::reach(&args.port, None, session.seed)?;
    let mut conversation = Conversation::open(&device.port)?;
    conversation.say(&ToDevice::Stop)?;
    let About { board, stage, .. } = conversation.about()?;
    session.deliver(
        &format!("{board}: stopped; it is in the stage {stage:?}\n"),
        &serde_json::json!({ "schema": "servoid.stopped/1", "board": board.as_str() }),
    )
}
