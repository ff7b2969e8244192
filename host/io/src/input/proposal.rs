//! How a log may be read: which column is what and in which unit, told by names, units and values together. `open` prints it, the page's
//! dialog begins with it, and where it is sure the other verbs take it.

use super::candidates::{Candidate, candidates};
use super::missing::for_shell;
use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
use super::motor_units::{AngleUnit, TimeUnit};
use super::names::Match;
use super::preset::{PRESETS, Preset};
use super::survey::SurveyTable;
use super::turns::{Turns, several};
use super::values::{angle_step, command_unit, is_plausible, time_unit};
use super::{quantity, units_told};
use crate::channel::{Channel, Measured};
use crate::position_loop::LoopSettings;
use crate::recording::Drive;

/// How a log may be read.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Proposal {
    /// What was known, with what is proposed.
    pub motor: MotorFile,
    /// What is proposed, in the order of the channels.
    pub columns: Vec<Proposed>,
    /// Whether the drive's kind is proposed.
    drive: bool,
    /// Rows of one motor among several that take turns.
    select: bool,
    /// Whether the values of the angle tell the counts per revolution.
    counts: bool,
    /// What is still to be said, a sentence each, with the option that says it.
    pub needs: Vec<Need>,
    /// Why it is not sure; empty where another verb may take it.
    pub doubts: Vec<String>,
    preset: bool,
}

/// A column that is proposed for a channel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Proposed {
    /// What it would be.
    pub channel: Channel,
    /// Its name, behind that of its table where that is needed.
    pub column: String,
    /// Its place: that of the table, and in it.
    place: (usize, usize),
    /// Its unit, as `[units]` calls it; none for the usual one.
    pub unit: Option<&'static str>,
    /// Why.
    pub why: String,
}

/// Something that the user must say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Need {
    /// The option with a blank for the value, as `--counts-per-rev N`.
    pub option: String,
    /// What it is.
    pub text: String,
}

impl Proposal {
    /// What is proposed for a log with these tables, beside what is known.
    pub(super) fn of(tables: &[SurveyTable], motor: &MotorFile, is_lerobot: bool) -> Self {
        let mut proposal = Proposal {
            motor: motor.clone(),
            ..Proposal::default()
        };
        let preset = match motor.log.preset {
            Some(_) => None,
            None if is_lerobot => Preset::by_name("lerobot"),
            None => likely(tables),
        };
        if let Some(preset) = preset {
            proposal.take_preset(preset);
        }
        let all = candidates(tables, &proposal.motor);
        let Some(best) = all
            .into_iter()
            .max_by_key(|one| (one.worth(), std::cmp::Reverse(one.place())))
        else {
            return proposal;
        };
        proposal.take(best, tables);
        proposal
    }

    fn take_preset(&mut self, preset: &'static Preset) {
        self.preset = true;
        self.motor.log.preset = Some(preset);
        self.motor.units = preset.units();
        match preset.drive {
            DriveKind::Voltage => {}
            DriveKind::Current => self.motor.drive = Drive::Current,
            DriveKind::Position => {
                self.motor.position = Some(self.motor.position.unwrap_or_default());
            }
        }
    }

    fn take(&mut self, best: Candidates, tables: &[SurveyTable]) {
        let known = self.motor.clone();
        let said = |channel| known.columns.get(channel).is_some();
        if let Some(kind) =
            (best.kind).filter(|kind| !known.drive_said && *kind != known.drive_kind())
        {
            self.drive = true;
            match kind {
                DriveKind::Current => self.motor.drive = Drive::Current,
                DriveKind::Position => self.motor.position = Some(LoopSettings::default()),
                DriveKind::Voltage => {}
            }
        }
        for found in &best.found {
            let Candidate {
                channel,
                column,
                place,
                how,
                unit,
                ..
            } = found;
            let profile = &tables[place.0].columns[place.1].profile;
            // A name that says duty does not say of what it is a share.
            let beyond = *channel == Channel::Command && profile.largest() > 1.05;
            let unit = unit.filter(|unit| !(beyond && *unit == "duty"));
            let unit = unit.or_else(|| self.unit_by_values(*channel, column, profile));
            let usual = self.is_usual(*channel, column);
            if !usual || best.joined {
                self.motor.columns.set(*channel, Some(column.clone()));
            }
            if let Some(unit) = unit {
                self.motor.set_unit(*channel, unit);
            }
            if *how < Match::Part && !said(*channel) {
                let key = self.motor.drive_kind().key(*channel);
                self.doubts
                    .push(format!("`{column}` may or may not be the {key}"));
            }
            self.columns.push(Proposed {
                channel: *channel,
                column: column.clone(),
                place: *place,
                unit,
                why: found.why.clone(),
            });
        }
        self.columns.sort_by_key(|one| one.channel);
        self.doubts.extend(best.doubts);
        if let Some(Turns { column, values }) = best.turns {
            let value = values.into_iter().next().unwrap_or_default();
            self.doubts.push(format!(
                "the rows of several motors take turns in `{column}`"
            ));
            self.motor
                .log
                .select
                .push(super::log_part::Selection { column, value });
            self.select = true;
        }
        self.what_is_needed();
    }

    /// Whether the reader finds a column by itself.
    fn is_usual(&self, channel: Channel, column: &str) -> bool {
        let names = match (self.motor.log.preset, channel) {
            // What changes the command's meaning is always said.
            (_, Channel::Direction | Channel::Measured(Measured::Supply)) => &[],
            (Some(preset), _) => preset.names_of(channel),
            (None, Channel::Command) if self.motor.position.is_some() => &[],
            (None, _) => &[channel.facts().column][..],
        };
        let mut names = names.iter();
        names.any(|name| name.eq_ignore_ascii_case(column))
    }

    /// The unit that the values of a column tell, where neither its name nor the file does.
    fn unit_by_values(
        &mut self,
        channel: Channel,
        name: &str,
        profile: &super::profile::Profile,
    ) -> Option<&'static str> {
        let known = &self.motor.units;
        let usual = self.motor.log.preset.is_none();
        match channel {
            Channel::Time if usual && known.time == TimeUnit::Seconds => time_unit(profile),
            Channel::Command if usual && self.motor.drive_kind() == DriveKind::Voltage => {
                let (unit, sure) = command_unit(name, profile);
                if !sure {
                    self.doubts
                        .push(format!("the unit of `{name}` is not sure"));
                }
                unit
            }
            Channel::Angle
                if usual && known.angle == AngleUnit::Counts && name != "angle_counts" =>
            {
                let Some((unit, counts)) = angle_step(profile) else {
                    if !profile.is_whole() {
                        self.doubts
                            .push(format!("the unit of `{name}` is not told"));
                        self.needs.push(Need {
                            option: "--unit angle=UNIT".to_owned(),
                            text: format!("the unit of `{name}`: deg, rad or rev"),
                        });
                    }
                    return None;
                };
                if self.motor.counts_per_rev.is_none() {
                    self.motor.counts_per_rev = Some(counts);
                    self.counts = true;
                }
                Some(unit)
            }
            _ => None,
        }
    }

    fn what_is_needed(&mut self) {
        let kind = self.motor.drive_kind();
        let has = |channel: Channel, proposal: &Proposal| {
            proposal.motor.columns.get(channel).is_some()
                || proposal.columns.iter().any(|one| one.channel == channel)
        };
        let mut need = |option: String, text: &str| {
            self.needs.push(Need {
                option,
                text: text.to_owned(),
            });
        };
        let (mut missing, motor) = (Vec::new(), self.motor.clone());
        for channel in [Channel::Time, Channel::Command, Channel::Angle] {
            let rate = channel == Channel::Time && motor.log.rate_hz.is_some();
            let own = motor.columns.get(channel).is_some()
                || self.columns.iter().any(|one| one.channel == channel);
            if !own && !rate {
                missing.push(channel);
            }
        }
        for channel in &missing {
            match channel {
                Channel::Time => need(
                    "--rate HZ".to_owned(),
                    "the samples a second, since no column looks like a time",
                ),
                channel => need(
                    format!("--column {}=NAME", kind.key(*channel)),
                    match channel {
                        Channel::Command => "the column of the command: none looks like one",
                        _ => "the column of the angle: none looks like one",
                    },
                ),
            }
        }
        if motor.encoder_counts().is_none() {
            need(
                "--counts-per-rev N".to_owned(),
                "the encoder's counts per revolution: its lines times 4",
            );
        }
        let is_share = motor.units.voltage.full_scale().is_some() || kind == DriveKind::Position;
        let measured = has(Channel::Measured(Measured::Supply), self);
        if is_share && !measured && motor.supply_v.is_none() {
            self.needs.push(Need {
                option: "--supply-v V".to_owned(),
                text: match kind {
                    DriveKind::Position => "the supply voltage, which limits the position loop",
                    _ => "the supply voltage, of which the command is a share",
                }
                .to_owned(),
            });
        }
        if !missing.is_empty() {
            self.doubts
                .push("a column that is needed is missing".to_owned());
        }
    }

    /// Whether another verb may take it without being told: each column that is needed was found, and its values agree.
    pub fn is_sure(&self) -> bool {
        self.doubts.is_empty() && !self.columns.is_empty()
    }

    /// Writes into tables what their columns may be.
    pub(super) fn mark(&self, tables: &mut [SurveyTable]) {
        let kind = self.motor.drive_kind();
        for one in &self.columns {
            let column = &mut tables[one.place.0].columns[one.place.1];
            column.guess = Some(kind.key(one.channel));
            column.guessed_unit = one.unit;
        }
    }

    /// The options that say what is proposed, ready for a shell.
    pub fn options(&self) -> Vec<String> {
        let mut words = Vec::new();
        let kind = self.motor.drive_kind();
        if let (true, Some(preset)) = (self.preset, self.motor.log.preset) {
            words.push(format!("--preset {}", preset.name));
        } else if self.drive {
            words.push(format!("--drive {}", kind.name()));
        }
        for one in &self.columns {
            let key = kind.key(one.channel);
            if self.motor.columns.get(one.channel) == Some(&one.column) {
                words.push(format!(
                    "--column {}",
                    for_shell(&format!("{key}={}", one.column))
                ));
            }
            let is_usual = one.channel == Channel::Command
                && kind == DriveKind::Current
                && one.unit == Some("A");
            if let Some(unit) = one.unit.filter(|_| !is_usual) {
                words.push(format!("--unit {key}={}", for_shell(unit)));
            }
        }
        if let (true, Some(counts)) = (self.counts, self.motor.counts_per_rev) {
            words.push(format!("--counts-per-rev {counts}"));
        }
        if let (true, [.., selection]) = (self.select, &self.motor.log.select[..]) {
            words.push(format!("--select {}", for_shell(&selection.to_string())));
        }
        words
    }

    /// What is taken, for people: `time from millis (ms), command from pwm (pwm8)`.
    pub fn taken(&self) -> String {
        let kind = self.motor.drive_kind();
        let each = self.columns.iter().map(|one| {
            let title = match (one.channel, kind) {
                (Channel::Command, DriveKind::Position) => "target".to_owned(),
                (channel, _) => channel.facts().title.to_lowercase(),
            };
            let unit = one.unit.map_or(String::new(), |unit| format!(" ({unit})"));
            format!("{title} from `{}`{unit}", one.column)
        });
        let each: Vec<String> = each.collect();
        each.join(", ")
    }
}

/// The best columns of one table, or of several that are joined.
pub(super) struct Candidates {
    /// The table; the first of all where they are joined.
    pub(super) table: usize,
    /// Whether columns of several tables are joined.
    pub(super) joined: bool,
    pub(super) found: Vec<Candidate>,
    /// The drive's kind that the columns tell.
    pub(super) kind: Option<DriveKind>,
    pub(super) turns: Option<Turns>,
    pub(super) doubts: Vec<String>,
}

impl Candidates {
    fn place(&self) -> (bool, usize) {
        (self.joined, self.table)
    }

    /// How much of what is needed was found, and how surely.
    fn worth(&self) -> usize {
        let worth = |one: &Candidate| match (one.channel, one.how) {
            (Channel::Command | Channel::Angle, how) => 30 + 3 * how as usize,
            (Channel::Time, how) => 10 + 2 * how as usize,
            _ => 1,
        };
        self.found.iter().map(worth).sum()
    }
}

/// The preset all of whose columns are in one table, and no other's are; its units agree with the values.
fn likely(tables: &[SurveyTable]) -> Option<&'static Preset> {
    let fits = |preset: &&Preset| {
        tables.iter().any(|table| {
            let column = |channel| {
                let mut names = preset.names_of(channel).iter();
                names.find_map(|name| table.columns.iter().find(|c| c.name == *name))
            };
            let all = (
                column(Channel::Time),
                column(Channel::Command),
                column(Channel::Angle),
            );
            let (Some(time), Some(command), Some(angle)) = all else {
                return false;
            };
            let as_time = match preset.time.unit {
                TimeUnit::Milliseconds => time_unit(&time.profile) == Some("ms"),
                _ => true,
            };
            let full = preset.command.unit.full_scale();
            let as_command = full.is_none_or(|full| {
                let largest = command.profile.largest();
                command.profile.is_whole() && largest <= 1.05 * full && largest > 1.0
            });
            let as_angle = preset.angle.unit != AngleUnit::Counts || angle.profile.is_whole();
            as_time && as_command && as_angle
        })
    };
    let mut fitting = PRESETS.iter().filter(fits);
    match (fitting.next(), fitting.next()) {
        (Some(preset), None) => Some(preset),
        _ => None,
    }
}

/// Motors that take turns in a table, as far as the column of the angle is known.
pub(super) fn turns_of(table: &SurveyTable, angle: usize) -> Option<Turns> {
    let columns: Vec<_> = (table.columns.iter())
        .map(|column| (column.name.clone(), column.profile.clone()))
        .collect();
    several(&columns, angle)
}

/// The unit that a name or the file tells of a column.
pub(super) fn told(channel: Channel, name: &str, unit: Option<&str>) -> Option<&'static str> {
    let by_file = unit.and_then(|unit| units_told::unit_of(channel, unit));
    by_file.or_else(|| quantity::told_unit(channel, name))
}

/// Whether a column may hold a channel: by its values, and by the unit that stands with its name.
pub(super) fn may_be(channel: Channel, name: &str, profile: &super::profile::Profile) -> bool {
    is_plausible(channel, profile) && !quantity::has_foreign_unit(channel, name)
}
