//! The motor file that `servoid simulate` leaves beside a recording.

use crate::error::Error;
use crate::session::Session;
use servoid_io::input::MotorFile;
use servoid_io::output::write_whole;
use std::path::Path;

/// Writes what is known of the motor, unless a file is there already: it may hold what its owner knows, and
/// other recordings beside it depend on it. Returns what to say of it.
pub(super) fn write_motor(
    session: &Session,
    path: &Path,
    motor: &MotorFile,
) -> Result<String, Error> {
    if !path.exists() {
        write_whole(path, |out| out.write_all(motor.to_toml().as_bytes()))?;
        return Ok(format!("what is known of the motor: {}", path.display()));
    }
    let disagrees = match MotorFile::read(path) {
        Err(error) => vec![format!("it cannot be used: {error}")],
        Ok(there) => disagreements(&there, motor),
    };
    if !disagrees.is_empty() {
        session.remark(&format!(
            "{} was there already and is kept, but it disagrees with this recording: {}; put the recording into \
             another folder, or give these facts to `servoid fit` as flags",
            path.display(),
            disagrees.join("; ")
        ));
    }
    Ok(format!("{} was there already and is kept", path.display()))
}

/// Where a motor file would make a recording of `motor` be misread, or tells of another motor.
fn disagreements(there: &MotorFile, motor: &MotorFile) -> Vec<String> {
    let shown = |value: Option<f64>| value.map_or_else(|| "nothing".to_owned(), |x| x.to_string());
    let mut found = Vec::new();
    for (key, theirs, ours) in [
        ("counts_per_rev", there.counts_per_rev, motor.counts_per_rev),
        ("supply_v", there.supply_v, motor.supply_v),
    ] {
        if theirs != ours {
            found.push(format!(
                "it says {key} = {}, here it is {}",
                shown(theirs),
                shown(ours)
            ));
        }
    }
    if there.name != motor.name {
        let name = |file: &MotorFile| file.name.clone().unwrap_or_else(|| "no name".to_owned());
        found.push(format!(
            "it is of `{}`, not of `{}`",
            name(there),
            name(motor)
        ));
    }
    for (section, differs) in [
        ("columns", there.columns != motor.columns),
        ("units", there.units != motor.units),
        (
            "drive",
            (there.drive, there.position) != (motor.drive, motor.position),
        ),
    ] {
        if differs {
            found.push(format!("its [{section}] is of another log"));
        }
    }
    found
}
