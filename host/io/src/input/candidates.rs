//! Which columns of a log may be which channels.

use super::motor_drive::DriveKind;
use super::motor_file::MotorFile;
use super::motor_units::CommandUnit;
use super::names::Match;
use super::proposal::{Candidates, may_be, told, turns_of};
use super::quantity::{commanded_current, is_speed_setpoint, speed, speed_unit, target};
use super::survey::{SurveyColumn, SurveyTable};
use super::values::{command_unit, follows};
use crate::channel::{Channel, Measured};

/// A column that may be a channel.
#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) channel: Channel,
    pub(super) column: String,
    /// Table, and column in it.
    pub(super) place: (usize, usize),
    pub(super) how: Match,
    /// The unit that its name, the file or its kind tells; none for the usual one.
    pub(super) unit: Option<&'static str>,
    pub(super) why: String,
}

/// A column with its place and the name by which it is asked for.
struct Named<'t> {
    column: &'t SurveyColumn,
    place: (usize, usize),
    name: String,
}

impl Named<'_> {
    /// Whether it may hold a channel, by its values and the unit that stands with its name.
    fn may_be(&self, channel: Channel) -> bool {
        may_be(channel, &self.column.name, &self.column.profile)
    }

    /// How surely its name means a channel that it may hold: the values are looked at first, which costs less.
    fn called(&self, channel: Channel) -> Option<(Match, usize)> {
        let called = || channel.facts().called(&self.column.name);
        self.may_be(channel).then(called).flatten()
    }
}

/// The best columns of each table; and of all together, where command and angle stand in different ones.
pub(super) fn candidates(tables: &[SurveyTable], motor: &MotorFile) -> Vec<Candidates> {
    let mut all: Vec<Candidates> = Vec::new();
    for (k, table) in tables.iter().enumerate() {
        let named: Vec<Named<'_>> = (table.columns.iter().enumerate())
            .map(|(at, column)| Named {
                column,
                place: (k, at),
                name: column.name.clone(),
            })
            .collect();
        all.push(of(&named, tables, motor, k, false));
    }
    let complete = |one: &Candidates| {
        let has = |channel| one.found.iter().any(|found| found.channel == channel);
        has(Channel::Command) && has(Channel::Angle)
    };
    if tables.len() > 1 && !all.iter().any(complete) {
        let mut named = Vec::new();
        for (k, table) in tables.iter().enumerate() {
            for (at, column) in table.columns.iter().enumerate().filter(|(_, c)| !c.is_time) {
                named.push(Named {
                    column,
                    place: (k, at),
                    name: format!("{}:{}", table.name, column.name),
                });
            }
        }
        let joined = of(&named, tables, motor, 0, true);
        if complete(&joined) {
            all.push(joined);
        }
    }
    all
}

fn of(
    named: &[Named<'_>],
    tables: &[SurveyTable],
    motor: &MotorFile,
    table: usize,
    joined: bool,
) -> Candidates {
    let mut finder = Finder {
        named,
        taken: Vec::new(),
        found: Vec::new(),
        motor,
        kind: motor.drive_kind(),
    };
    finder.said();
    finder.preset();
    finder.time(joined);
    let kind = finder.command_and_angle();
    finder.others();
    let mut doubts = finder.rivals();
    let turns = finder
        .found(Channel::Angle)
        .filter(|_| !joined && motor.log.select.is_empty())
        .and_then(|angle| turns_of(&tables[table], angle.place.1));
    if let Some(turns) = &turns {
        finder.found.retain(|one| one.column != turns.column);
    }
    if !finder.has(Channel::Command)
        && let Some(setpoint) = named.iter().find(|one| is_speed_setpoint(&one.name))
    {
        doubts.push(format!(
            "`{}` is the setpoint of a speed loop, which is no voltage",
            setpoint.name
        ));
    }
    Candidates {
        table,
        joined,
        found: finder.found,
        kind,
        turns,
        doubts,
    }
}

struct Finder<'t> {
    named: &'t [Named<'t>],
    /// Places in `named` that are something already.
    taken: Vec<usize>,
    found: Vec<Candidate>,
    motor: &'t MotorFile,
    kind: DriveKind,
}

impl Finder<'_> {
    /// What was found for a channel.
    fn found(&self, channel: Channel) -> Option<&Candidate> {
        self.found.iter().find(|one| one.channel == channel)
    }

    fn has(&self, channel: Channel) -> bool {
        self.found(channel).is_some()
    }

    /// The column that was found for a channel.
    fn column(&self, channel: Channel) -> Option<&SurveyColumn> {
        let place = self.found(channel)?.place;
        let one = self.named.iter().find(|one| one.place == place);
        one.map(|one| one.column)
    }

    fn take(&mut self, at: usize, channel: Channel, how: Match, why: &str) {
        let Named {
            column,
            place,
            name,
        } = &self.named[at];
        self.taken.push(at);
        self.found.push(Candidate {
            channel,
            column: name.clone(),
            place: *place,
            how,
            unit: told(channel, &column.name, column.unit.as_deref()),
            why: why.to_owned(),
        });
    }

    /// What the user has named.
    fn said(&mut self) {
        for (channel, name) in self.motor.columns.iter() {
            let at = self.named.iter().position(|one| one.name == name);
            if let Some(at) = at {
                self.take(at, channel, Match::Whole, "you say so");
                // Its unit is the user's to say as well.
                if let Some(last) = self.found.last_mut() {
                    last.unit = None;
                }
            }
        }
    }

    /// What the preset names.
    fn preset(&mut self) {
        let Some(preset) = self.motor.log.preset else {
            return;
        };
        for channel in Channel::ALL {
            if self.has(channel) {
                continue;
            }
            let names = preset.names_of(channel);
            let called = |is: &dyn Fn(&str, &str) -> bool| {
                let free = |at: &usize| {
                    let one = &self.named[*at];
                    let of_axes = matches!(channel, Channel::Command | Channel::Angle);
                    !self.taken.contains(at) && (!of_axes || !one.column.profile.is_constant())
                };
                let own = |name: &&str| {
                    let mut all = 0..self.named.len();
                    all.find(|at| is(&self.named[*at].name, name) && free(at))
                };
                names.iter().find_map(own)
            };
            let exact = called(&|own, name| own == name);
            // A vector has a column for each of its axes.
            let axis = || called(&|own, name| has_axis(own, name));
            let Some(at) = exact.or_else(axis) else {
                continue;
            };
            self.take(at, channel, Match::Whole, "the preset says so");
            if let Some(last) = self.found.last_mut() {
                last.unit = None;
            }
        }
    }

    /// The free column that some judge calls best.
    fn best(&self, judge: &dyn Fn(&Named<'_>) -> Option<(Match, usize)>) -> Option<(usize, Match)> {
        let free = (0..self.named.len()).filter(|at| !self.taken.contains(at));
        let judged = free.filter_map(|at| Some((at, judge(&self.named[at])?)));
        let best = judged.min_by_key(|(at, (how, place))| (std::cmp::Reverse(*how), *place, *at));
        best.map(|(at, (how, _))| (at, how))
    }

    fn time(&mut self, joined: bool) {
        if self.has(Channel::Time) || self.motor.log.rate_hz.is_some() || joined && self.all_timed()
        {
            return;
        }
        if let Some(at) = self.named.iter().position(|one| one.column.is_time) {
            if !joined {
                self.take(
                    at,
                    Channel::Time,
                    Match::Whole,
                    "the file says that it is a time",
                );
            }
            return;
        }
        let best = self.best(&|one| one.called(Channel::Time));
        if let Some((at, how)) = best {
            self.take(at, Channel::Time, how, "its name, and it rises");
        }
    }

    /// Whether every table has times of its own, which columns without one of theirs show.
    fn all_timed(&self) -> bool {
        self.named.iter().all(|one| one.column.is_number)
            && self.named.iter().all(|one| !one.column.is_time)
            && self.motor.columns.get(Channel::Time).is_none()
            && !self
                .named
                .iter()
                .any(|one| one.called(Channel::Time).is_some())
    }

    /// The command and the angle, and the kind of drive that they tell.
    fn command_and_angle(&mut self) -> Option<DriveKind> {
        let by_name = |one: &Named<'_>, channel: Channel| {
            if !one.may_be(channel) || speed_unit(&one.column.name).is_some() {
                return None;
            }
            let own = channel.facts().called(&one.name);
            own.filter(|(how, _)| *how > Match::Nearly || !is_another(channel, &one.column.name))
        };
        let angle = |one: &Named<'_>| by_name(one, Channel::Angle);
        let volts = |one: &Named<'_>| by_name(one, Channel::Command);
        let mut kind = None;
        if !self.has(Channel::Command)
            && self.kind == DriveKind::Voltage
            && let Some((at, how)) = self.best(&volts).filter(|(_, how)| *how >= Match::Part)
        {
            self.take(at, Channel::Command, how, "its name");
            if self
                .found
                .last()
                .is_some_and(|last| is_of_current(last.unit))
            {
                kind = Some(DriveKind::Current);
            }
        }
        if !self.has(Channel::Angle) {
            if let Some((at, how)) = self.best(&angle) {
                self.take(at, Channel::Angle, how, "its name");
            } else if let Some((at, how)) = self.best(&|one| {
                let plausible = one.may_be(Channel::Angle);
                speed(&one.column.name).filter(|_| plausible)
            }) {
                self.take(at, Channel::Angle, how, "its name, as a speed");
                if let Some(last) = self.found.last_mut() {
                    let unit = speed_unit(&last.column).or(last.unit);
                    last.unit = Some(unit.unwrap_or("rad/s"));
                    if unit.is_none() {
                        last.how = Match::Nearly;
                    }
                }
            }
        }
        if !self.has(Channel::Command) {
            kind = self.commanded_otherwise().or(kind);
        }
        if !self.has(Channel::Command)
            && let Some((at, how)) = self.best(&volts)
        {
            self.take(at, Channel::Command, how, "its name, nearly");
        }
        self.the_last_one();
        kind
    }

    /// A target that the angle follows, or a current.
    fn commanded_otherwise(&mut self) -> Option<DriveKind> {
        if self.motor.drive_said && self.kind == DriveKind::Voltage {
            return None;
        }
        let current = self.best(&|one| {
            let plausible = one.may_be(Channel::Command);
            let unit = told(
                Channel::Command,
                &one.column.name,
                one.column.unit.as_deref(),
            );
            let own = commanded_current(&one.column.name);
            own.filter(|_| plausible && (is_of_current(unit) || self.kind == DriveKind::Current))
        });
        if let Some((at, how)) = current.filter(|_| self.kind != DriveKind::Position) {
            self.take(at, Channel::Command, how, "its name and unit");
            return Some(DriveKind::Current);
        }
        let angle = self.found(Channel::Angle)?;
        let (unit, name) = (angle.unit, angle.column.clone());
        let profile = &self.column(Channel::Angle)?.profile;
        let axis = behind_the_last_dot(&name);
        let found = self.best(&|one| {
            let (how, at) = target(&one.column.name)?;
            let same_axis = axis.is_none() || axis == behind_the_last_dot(&one.name);
            let fits = one.may_be(Channel::Angle) && follows(profile, &one.column.profile);
            fits.then_some((how, 2 * at + usize::from(!same_axis)))
        });
        let (at, how) = found?;
        self.take(
            at,
            Channel::Command,
            how,
            "its name, and the angle follows it",
        );
        if let Some(last) = self.found.last_mut() {
            // The target has the angle's unit if nothing else is said.
            last.unit = last.unit.filter(|own| Some(*own) != unit);
        }
        Some(DriveKind::Position)
    }

    /// Where time and command are known, the only other column that moves is the angle.
    fn the_last_one(&mut self) {
        if self.has(Channel::Angle) || !self.has(Channel::Command) {
            return;
        }
        let moving: Vec<usize> = (0..self.named.len())
            .filter(|at| !self.taken.contains(at))
            .filter(|at| {
                let one = &self.named[*at];
                let is_known = || {
                    Channel::ALL.into_iter().any(|channel| {
                        channel != Channel::Angle
                            && channel.facts().called(&one.column.name).is_some()
                    })
                };
                one.may_be(Channel::Angle) && !is_known()
            })
            .collect();
        if let [only] = moving[..] {
            self.take(
                only,
                Channel::Angle,
                Match::Part,
                "the only column that is left",
            );
        }
    }

    fn others(&mut self) {
        let column = self.column(Channel::Command);
        let told = self.found(Channel::Command).and_then(|one| one.unit);
        let by_values = || command_unit(&column?.name, &column?.profile).0;
        let unit = told.or_else(by_values).and_then(CommandUnit::by_name);
        let is_share = unit.is_some_and(|unit| unit.full_scale().is_some())
            || self.motor.units.voltage.full_scale().is_some();
        let range = column.and_then(|column| column.profile.range());
        let unsigned = range.is_some_and(|[least, _]| least >= 0.0);
        for channel in Channel::ALL {
            let wanted = match channel {
                Channel::Measured(Measured::Supply) => is_share,
                Channel::Direction => unsigned,
                Channel::Measured(_) | Channel::Enabled => true,
                _ => false,
            };
            if !wanted || self.has(channel) {
                continue;
            }
            let best = self.best(&|one| {
                let joined_without_time = one.name != one.column.name && one.column.is_time;
                let own = one.called(channel).filter(|_| !joined_without_time);
                own.filter(|(how, _)| *how >= Match::Part)
            });
            if let Some((at, how)) = best {
                self.take(at, channel, how, "its name");
            }
        }
    }

    /// Doubts where another free column is called as surely and as well.
    fn rivals(&self) -> Vec<String> {
        let mut doubts = Vec::new();
        for one in &self.found {
            if !matches!(one.channel, Channel::Command | Channel::Angle) || one.why == "you say so"
            {
                continue;
            }
            let facts = one.channel.facts();
            let own = facts.called(&one.column);
            let rival = (0..self.named.len()).find(|at| {
                let named = &self.named[*at];
                !self.taken.contains(at)
                    && own.is_some()
                    && named.may_be(one.channel)
                    && facts.called(&named.name) == own
            });
            if let Some(rival) = rival {
                doubts.push(format!(
                    "`{}` and `{}` may both be the {}",
                    one.column,
                    self.named[rival].name,
                    facts.title.to_lowercase()
                ));
            }
        }
        doubts
    }
}

/// Whether a column is an axis of the vector of this name: `action.shoulder.pos`, `position[2]`.
fn has_axis(column: &str, vector: &str) -> bool {
    let rest = column.strip_prefix(vector);
    rest.is_some_and(|rest| rest.starts_with(['.', '[']))
}

/// The joint of a name such as `observation.state.shoulder_pan.pos`.
fn behind_the_last_dot(name: &str) -> Option<String> {
    let parts: Vec<&str> = name.split('.').collect();
    (parts.len() > 2).then(|| parts[parts.len() - 2..].join("."))
}

/// Whether a unit is one of what a drive with a current loop is told.
fn is_of_current(unit: Option<&str>) -> bool {
    let unit = unit.and_then(CommandUnit::by_name);
    unit.is_some_and(CommandUnit::is_of_current)
}

/// Whether a name surely means a speed or another channel.
fn is_another(own: Channel, name: &str) -> bool {
    let surely = |channel: Channel| {
        let called = channel.facts().called(name);
        channel != own && called.is_some_and(|(how, _)| how > Match::Nearly)
    };
    speed(name).is_some() || Channel::ALL.into_iter().any(surely)
}
