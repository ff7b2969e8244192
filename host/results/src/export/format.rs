//! The list of formats: the command line, the help, the tests and the documentation follow from it.

use super::error::ExportError;
use super::options::Options;
use super::subject::Subject;
use super::written::Written;
use super::{
    bam, c, csv, gains, json, mjlab, modelica, moteus, mujoco, odrive, python, ros2_control, rust,
    simscape, toml, urdf, vesc, wpilib,
};

/// One format.
pub struct Format {
    /// Its name on the command line.
    pub name: &'static str,
    /// What it is, in a line.
    pub about: &'static str,
    /// Writes it.
    pub write: fn(&Subject, &Options) -> Result<Written, ExportError>,
}

/// Every format.
pub const FORMATS: &[Format] = &[
    Format {
        name: "toml",
        about: "all parameters; its [known] section fits into a motor.toml",
        write: toml::write,
    },
    Format {
        name: "json",
        about: "all parameters",
        write: json::write,
    },
    Format {
        name: "csv",
        about: "all parameters, a row each",
        write: csv::write,
    },
    Format {
        name: "c",
        about: "a header with constants and the exact step at the sample interval",
        write: c::write,
    },
    Format {
        name: "rust",
        about: "a module with the same",
        write: rust::write,
    },
    Format {
        name: "python",
        about: "a module with the same",
        write: python::write,
    },
    Format {
        name: "mujoco",
        about: "joint and dcmotor actuator of MuJoCo; needs torques in N*m",
        write: mujoco::write,
    },
    Format {
        name: "urdf",
        about: "<dynamics> of a joint; needs torques in N*m",
        write: urdf::write,
    },
    Format {
        name: "modelica",
        about: "a record in SI units",
        write: modelica::write,
    },
    Format {
        name: "wpilib",
        about: "kS, kV, kA in volts, as Java constants",
        write: wpilib::write,
    },
    Format {
        name: "gains",
        about: "PI controllers and feed-forward with their margins, as TOML",
        write: gains::write,
    },
    Format {
        name: "bam",
        about: "parameter file of bam (Rhoban): motor and friction of a servo; needs torques in N*m",
        write: bam::write,
    },
    Format {
        name: "mjlab",
        about: "DcMotorActuatorCfg of mjlab, as Python; needs torques in N*m",
        write: mjlab::write,
    },
    Format {
        name: "simscape",
        about: "workspace variables for Simscape's DC Motor, as MATLAB; needs torques in N*m",
        write: simscape::write,
    },
    Format {
        name: "ros2-control",
        about: "a speed controller of ROS 2 (pid_controller), as YAML",
        write: ros2_control::write,
    },
    Format {
        name: "odrive",
        about: "an ODrive's settings; needs the resistance",
        write: odrive::write,
    },
    Format {
        name: "vesc",
        about: "a VESC's settings, as LispBM; needs the resistance",
        write: vesc::write,
    },
    Format {
        name: "moteus",
        about: "a moteus's settings; needs the resistance",
        write: moteus::write,
    },
];

impl Format {
    /// The format of this name.
    pub fn by_name(name: &str) -> Option<&'static Format> {
        FORMATS.iter().find(|format| format.name == name)
    }
}
