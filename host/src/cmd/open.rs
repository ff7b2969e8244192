//! `servoid open`: what a log holds, drawn if asked for, and the command that would fit it.

use super::motor;
use super::progress::FileBar;
use crate::cli::{MotorArgs, OpenArgs};
use crate::error::Error;
use crate::session::Session;
use servoid_io::input::{MotorFile, Survey, SurveyColumn, SurveyTable, for_shell, survey};
use servoid_results::plot;
use servoid_results::report::opened::text;
use servoid_results::schema::opened::Opened;

pub(super) fn run(session: &Session, args: &OpenArgs) -> Result<(), Error> {
    let plot = args.plot.as_deref().map(|path| ("--plot", path));
    motor::check_outputs(session, plot.as_slice(), &args.motor, &args.log, None)?;
    let motor = motor::motor_file(&args.motor, &args.log)?;
    let bar = FileBar::new(session, "open");
    let survey = survey(&args.log, &motor, &|reached| bar.reached(reached))?;
    drop(bar);
    if let Some(path) = &args.plot {
        let name = args.log.file_name().unwrap_or(args.log.as_os_str());
        let drawing = plot::columns(&name.to_string_lossy(), &survey)?;
        session.write_plot(path, &drawing)?;
    }
    let file = args.log.display().to_string();
    let (command, needs) = fitting(&file, &survey, &motor, &given(&args.motor));
    let opened = Opened::new(&file, &survey, command, needs);
    session.deliver(&text(&opened), &opened)
}

/// The command that would fit the log, and what it still needs.
fn fitting(
    file: &str,
    survey: &Survey,
    motor: &MotorFile,
    given: &[String],
) -> (String, Vec<String>) {
    let mut words = vec!["servoid fit".to_owned(), for_shell(file)];
    words.extend_from_slice(given);
    let mut needs = Vec::new();
    let table = most_guessed(survey);
    if let Some(preset) = survey.preset {
        words.push(format!("--preset {}", preset.name));
    } else if let Some(table) = table {
        let columns = table.columns.iter();
        for (key, column) in columns.filter_map(|column| Some((column.guess?, column))) {
            if !is_said(key, motor) {
                words.extend(mapped(key, column));
            }
        }
    }
    if survey.preset.is_none() {
        let found = |key: &str| {
            is_said(key, motor)
                || table.is_some_and(|table| table.columns.iter().any(|c| c.guess == Some(key)))
        };
        if !found("time") && motor.log.rate_hz.is_none() {
            words.push("--rate HZ".to_owned());
            needs.push("no column looks like a time: say the samples a second".to_owned());
        }
        for (key, what) in [
            (motor.drive_kind().command_key(), "the command"),
            ("angle", "the angle"),
        ] {
            if !found(key) {
                words.push(format!("--column {key}=NAME"));
                needs.push(format!("no column looks like {what}: name it"));
            }
        }
    }
    let told = survey.preset.and_then(|preset| preset.counts_per_rev);
    if motor.encoder_counts().or(told).is_none() {
        words.push("--counts-per-rev N".to_owned());
        needs.push("say the encoder's counts per revolution (its lines times 4)".to_owned());
    }
    let unit = survey.preset.map(|preset| preset.command.unit).or_else(|| {
        let told = table?.columns.iter().find(|c| c.guess == Some("voltage"))?;
        let name = told.guessed_unit?;
        let all = servoid_io::input::CommandUnit::ALL.iter();
        all.clone()
            .find(|(own, _)| *own == name)
            .map(|(_, unit)| *unit)
    });
    if unit.is_some_and(|unit| unit.full_scale().is_some()) && motor.supply_v.is_none() {
        words.push("--supply-v V".to_owned());
        needs.push("the command is a share of the supply: say its voltage".to_owned());
    }
    (words.join(" "), needs)
}

/// The table of which most is guessed.
fn most_guessed(survey: &Survey) -> Option<&SurveyTable> {
    // Of equals the first.
    let tables = survey.tables.iter().rev();
    tables.max_by_key(|table| table.guessed())
}

/// Whether the user has named the column for a key.
fn is_said(key: &str, motor: &MotorFile) -> bool {
    let columns = &motor.columns;
    let named = match key {
        "time" => &columns.time,
        "voltage" | "target" => &columns.voltage,
        "angle" => &columns.angle,
        "current" => &columns.current,
        "temperature" => &columns.temperature,
        _ => &columns.enabled,
    };
    named.is_some()
}

/// What the user has said by flags, to stand in the command as well.
fn given(args: &MotorArgs) -> Vec<String> {
    let texts = |flag: &str, values: &[String]| -> Vec<String> {
        let each = values.iter();
        each.map(|value| format!("{flag} {}", for_shell(value)))
            .collect()
    };
    let number = |flag: &str, value: Option<f64>| value.map(|value| format!("{flag} {value}"));
    let mut words = [
        texts("--column", &args.column),
        texts("--unit", &args.unit),
        texts("--drive", args.drive.as_slice()),
        texts("--table", args.table.as_slice()),
        texts("--select", &args.select),
    ]
    .concat();
    let motor = args.motor.as_ref();
    words.extend(motor.map(|path| format!("--motor {}", for_shell(&path.display().to_string()))));
    words.extend(number("--counts-per-rev", args.counts_per_rev));
    words.extend(number("--supply-v", args.supply));
    words.extend(number("--metres-per-rev", args.metres_per_rev));
    words.extend(number("--rate", args.rate));
    words.extend(number("--from", args.from));
    words.extend(number("--to", args.to));
    words
}

/// The flags that map a column, none where the reader finds it by itself.
fn mapped(key: &str, column: &SurveyColumn) -> Vec<String> {
    let mut flags = Vec::new();
    let usual = match key {
        "time" => "t_s",
        "voltage" => "voltage_v",
        "angle" => "angle_counts",
        "current" => "current_a",
        "temperature" => "temperature_c",
        "enabled" => "enabled",
        _ => "",
    };
    if !column.is_time && !column.name.eq_ignore_ascii_case(usual) {
        let named = format!("{key}={}", column.name);
        flags.push(format!("--column {}", for_shell(&named)));
    }
    if let Some(unit) = column.guessed_unit {
        flags.push(format!("--unit {key}={unit}"));
    }
    flags
}
