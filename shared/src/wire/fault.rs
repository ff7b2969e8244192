//! Why a run was given up.

use core::fmt;
use serde::{Deserialize, Serialize};

/// Why a run was given up: the cause code of a report. Append only.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Fault {
    /// The user or the host asked to stop.
    Stopped,
    /// The host fell silent.
    LinkLost,
    /// A control period took longer than it may.
    Overrun,
    /// The bridge's own protection switched it off.
    Bridge,
    /// The shaft did not move although the drive was strong.
    Stall,
    /// The shaft left the travel that it was allowed.
    Overtravel,
    /// The model did not predict the recording that it had not seen.
    NotVerified,
    /// The shaft runs away against the drive: the encoder counts the wrong way.
    Runaway,
    /// More current than allowed.
    Overcurrent,
    /// The winding would get too hot.
    Overheated,
    /// More counts a period than allowed.
    Overspeed,
    /// The run took longer than allowed.
    TimeUp,
    /// The recording holds nothing to fit.
    NothingToFit,
    /// The count goes to and fro while the motor turns: one of the encoder's lines is dead.
    EncoderLine,
    /// The count changed by more than any motor can turn.
    EncoderJump,
    /// No current flows and nothing moves although the bridge drives.
    MotorLead,
    /// The motor gains speed without a current: the sensor shows none.
    CurrentSensor,
    /// The supply is above what it may be: the motor brakes into it.
    Overvoltage,
    /// The supply is below what it may be.
    Undervoltage,
    /// The bridge is too hot.
    BridgeHot,
    /// Several readings of the encoder in a row were unusable.
    Encoder,
    /// The motor is not the one whose servo was kept.
    OtherMotor,
}

impl Fault {
    /// All of them, in the order of the wire.
    pub const ALL: [Fault; 22] = [
        Fault::Stopped,
        Fault::LinkLost,
        Fault::Overrun,
        Fault::Bridge,
        Fault::Stall,
        Fault::Overtravel,
        Fault::NotVerified,
        Fault::Runaway,
        Fault::Overcurrent,
        Fault::Overheated,
        Fault::Overspeed,
        Fault::TimeUp,
        Fault::NothingToFit,
        Fault::EncoderLine,
        Fault::EncoderJump,
        Fault::MotorLead,
        Fault::CurrentSensor,
        Fault::Overvoltage,
        Fault::Undervoltage,
        Fault::BridgeHot,
        Fault::Encoder,
        Fault::OtherMotor,
    ];

    /// The unit of the number that broke the limit, and of the limit; nothing where there is none.
    pub const fn unit(self) -> &'static str {
        match self {
            Fault::Overtravel | Fault::Runaway | Fault::EncoderJump => "counts",
            Fault::NotVerified => "hundredths of a count RMS",
            Fault::Overcurrent | Fault::Overheated => "mA",
            Fault::Overspeed => "counts a period",
            Fault::TimeUp => "periods",
            Fault::OtherMotor => "percent",
            Fault::Overvoltage | Fault::Undervoltage => "mV",
            Fault::Stopped
            | Fault::Stall
            | Fault::EncoderLine
            | Fault::BridgeHot
            | Fault::Encoder
            | Fault::MotorLead
            | Fault::CurrentSensor
            | Fault::LinkLost
            | Fault::Overrun
            | Fault::Bridge
            | Fault::NothingToFit => "",
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Fault::Stopped => "stopped on request",
            Fault::LinkLost => "the host fell silent: check the cable, then start again",
            Fault::Overrun => "a control period took too long: the board is too busy, or its period too short",
            Fault::Bridge => "the bridge's protection switched it off: check the supply and the motor's leads",
            Fault::Stall => "the shaft did not move at strong drive: free it, check the motor's and the encoder's leads",
            Fault::Overtravel => "the shaft left its allowed travel: allow more, or ask for a smaller amplitude",
            Fault::NotVerified => "the model did not predict a fresh recording: diagnose the recording on the host",
            Fault::Runaway => "the encoder is reversed, the shaft ran against the drive: swap the encoder's channels, or the motor's leads; or a load turns it, which a brake or a counterweight holds",
            Fault::Overcurrent => "the current exceeded its limit: raise the limit if the motor bears it, or ask for a smaller amplitude",
            Fault::Overheated => "the winding would get too hot: let it cool, ask for a smaller amplitude or a shorter run",
            Fault::Overspeed => "the shaft was faster than allowed: ask for a smaller amplitude",
            Fault::TimeUp => "the run took longer than allowed: allow more time, or ask for less",
            Fault::NothingToFit => "the recording holds no motion to fit: ask for a larger amplitude",
            Fault::EncoderLine => "one encoder line is dead, the count goes to and fro while the motor turns: check both lines, their supply and pull-ups",
            Fault::EncoderJump => "the count jumped by more than a motor can turn: shield the encoder's lines, check its connector and supply",
            Fault::MotorLead => "no current flows although the bridge drives: check the motor's leads and the bridge's supply",
            Fault::CurrentSensor => "the motor runs but the current sensor shows no current: check the sensor; without it the current cannot be limited",
            Fault::Overvoltage => "the supply rose too far, the motor brakes into it: add a brake resistor or capacitance, or ask for a smaller amplitude",
            Fault::Undervoltage => "the supply broke down: it bears too little current for this drive; ask for a smaller amplitude, or take a stronger supply",
            Fault::BridgeHot => "the bridge is too hot: let it cool, cool it better, or ask for a smaller amplitude",
            Fault::OtherMotor => "the motor is not the one whose servo was kept: its gain or its acceleration has changed; check supply and load, or tune again",
            Fault::Encoder => "the encoder's readings were unusable: check its wires, its supply and its magnet",
        })
    }
}

impl core::error::Error for Fault {}
