//! Motors drawn from a population: joint draws of all parameters, as tables and as models.

use crate::error::Error;
use crate::population::Population;
use arrow_array::{ArrayRef, Float64Array, RecordBatch};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use ndarray::Array1;
use ndarray_npy::NpzWriter;
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use servoid_results::export::{Format, Options, Side, Subject};
use servoid_results::schema::{Identified, Machine};
use shared::motor::{Machine as Referred, Physical};
use shared::rng::{normal, seeded, uniform};
use std::f64::consts::{PI, TAU};
use std::io::Cursor;
use std::sync::Arc;

/// How often a motor is drawn again that no motor can be.
const TRIES: usize = 1000;
/// The six that make a motor, in the order of [`Physical`].
const PHYSICAL: [&str; 6] = ["resistance", "inductance", "kt", "kb", "inertia", "viscous"];

/// Drawn motors: a row each, a column a parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct Draws {
    /// The parameters.
    pub names: Vec<String>,
    /// Their units.
    pub units: Vec<String>,
    /// One a motor, in the order of the names.
    pub rows: Vec<Vec<f64>>,
}

/// Draws `count` motors. The first ones are the same, however many are asked for.
///
/// # Errors
/// A population from which nearly nothing can be drawn that a motor can be.
pub fn draw(population: &Population, count: usize, seed: u64) -> Result<Draws, Error> {
    let members = &population.parameters;
    let factor = factor(population);
    let unit_of = |name: &str| {
        let found = members.iter().find(|member| member.name == name);
        found.map_or_else(String::new, |member| member.unit.clone())
    };
    let mut names: Vec<String> = members.iter().map(|member| member.name.clone()).collect();
    let mut units: Vec<String> = members.iter().map(|member| member.unit.clone()).collect();
    for fixed in &population.fixed {
        names.push(fixed.name.clone());
        units.push(fixed.unit.clone());
    }
    for equal in &population.equal {
        names.push(equal.name.clone());
        units.push(unit_of(&equal.to));
    }
    for phase in &population.phases {
        names.push(phase.clone());
        units.push("rad".to_owned());
    }
    let mut rng = seeded(seed);
    let mut rows = Vec::with_capacity(count);
    for _ in 0..count {
        let drawn = (0..TRIES).find_map(|_| {
            let even = DVector::from_fn(members.len(), |_, _| normal::<f64>(&mut rng));
            let away = &factor * even;
            let values = members.iter().zip(away.iter());
            let values: Vec<f64> = values
                .map(|(member, away)| member.scale.raise(member.centre + away))
                .collect();
            let can_be = members.iter().zip(&values).all(|(member, value)| {
                value.is_finite() && member.least.is_none_or(|least| *value >= least)
            });
            can_be.then_some(values)
        });
        let mut row = drawn.ok_or_else(|| {
            Error::TooLittle(format!(
                "of {TRIES} draws none is a motor: the spreads of this population are larger than its means"
            ))
        })?;
        row.extend(population.fixed.iter().map(|fixed| fixed.value));
        for equal in &population.equal {
            let place = members.iter().position(|member| member.name == equal.to);
            row.push(place.map_or(f64::NAN, |place| row[place]));
        }
        row.extend(
            population
                .phases
                .iter()
                .map(|_| TAU * uniform::<f64>(&mut rng) - PI),
        );
        rows.push(row);
    }
    Ok(Draws { names, units, rows })
}

/// A square root of the covariance in the scales.
fn factor(population: &Population) -> DMatrix<f64> {
    let members = &population.parameters;
    let width = members.len();
    if width == 0 {
        return DMatrix::zeros(0, 0);
    }
    let covariance = DMatrix::from_fn(width, width, |j, k| {
        population.correlation[j][k] * members[j].spread * members[k].spread
    });
    // The scales differ by orders of magnitude, and what is possible is on the edge where two go together.
    let found = SymmetricEigen::new(covariance);
    let roots = found.eigenvalues.map(|value| value.max(0.0).sqrt());
    found.eigenvectors * DMatrix::from_diagonal(&roots)
}

impl Draws {
    fn column(&self, k: usize) -> Vec<f64> {
        self.rows.iter().map(|row| row[k]).collect()
    }

    /// As `.npz` of numpy: an array a parameter, under its name.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn npz(&self) -> Result<Vec<u8>, Error> {
        let failed = |error: &dyn std::fmt::Display| Error::Export(format!("npz: {error}"));
        let mut bytes = Cursor::new(Vec::new());
        let mut writer = NpzWriter::new(&mut bytes);
        for (k, name) in self.names.iter().enumerate() {
            let column = Array1::from(self.column(k));
            writer
                .add_array(name.as_str(), &column)
                .map_err(|error| failed(&error))?;
        }
        writer.finish().map_err(|error| failed(&error))?;
        Ok(bytes.into_inner())
    }

    /// As Parquet: a column a parameter.
    ///
    /// # Errors
    /// What cannot be written.
    pub fn parquet(&self) -> Result<Vec<u8>, Error> {
        let failed = |error: &dyn std::fmt::Display| Error::Export(format!("parquet: {error}"));
        let columns = self.names.iter().enumerate().map(|(k, name)| {
            let column: ArrayRef = Arc::new(Float64Array::from(self.column(k)));
            (name.as_str(), column)
        });
        let batch = RecordBatch::try_from_iter(columns).map_err(|error| failed(&error))?;
        let small = WriterProperties::builder()
            .set_compression(Compression::ZSTD(ZstdLevel::default()))
            .build();
        let mut bytes = Vec::new();
        let writer = ArrowWriter::try_new(&mut bytes, batch.schema(), Some(small));
        let mut writer = writer.map_err(|error| failed(&error))?;
        writer.write(&batch).map_err(|error| failed(&error))?;
        writer.close().map_err(|error| failed(&error))?;
        Ok(bytes)
    }

    /// Motor `number` in a format of `servoid export`, as in `mujoco`.
    ///
    /// # Errors
    /// A format that cannot hold such a motor, with the remedy.
    pub fn model(
        &self,
        population: &Population,
        number: usize,
        format: &str,
    ) -> Result<String, Error> {
        let format = Format::by_name(format)
            .ok_or_else(|| Error::Usage(format!("--to {format}: there is no such format")))?;
        let mut identified = Identified::parse(&population.typical.to_string())
            .map_err(|fault| Error::Export(format!("the population's typical result{fault}")))?;
        self.put(number, &mut identified)?;
        let source = format!(
            "motor {number} of a population of {} motors",
            population.motors
        );
        let failed = |error: &dyn std::fmt::Display| Error::Export(error.to_string());
        let subject = Subject::new(&identified, &source, Side::Motor);
        let subject = subject.map_err(|error| failed(&error))?;
        let written = (format.write)(&subject, &Options::default());
        Ok(written.map_err(|error| failed(&error))?.text)
    }

    /// Puts a drawn motor's numbers in the place of the typical one's.
    fn put(&self, number: usize, into: &mut Identified) -> Result<(), Error> {
        let row = &self.rows[number];
        let value = |name: &str| {
            let place = self.names.iter().position(|own| own == name);
            place.map(|place| row[place])
        };
        for found in &mut into.parameters {
            let (effect, parameter) = found.name.split_once('.').unwrap_or((&found.name, ""));
            let wave = || {
                let part = |what: &str| value(&format!("{effect}.{what}"));
                let (size, phase) = (part("amplitude")?, part("phase")?);
                match parameter {
                    _ if parameter.starts_with("cosine") => Some(size * libm::cos(phase)),
                    _ if parameter.starts_with("sine") => Some(size * libm::sin(phase)),
                    _ => None,
                }
            };
            if let Some(drawn) = value(&found.name).or_else(wave) {
                found.value = drawn;
            }
        }
        let of = |name: &str| {
            let found = into.parameters.iter().find(|found| found.name == name);
            found.map(|found| (found.value, found.unit.clone()))
        };
        let six: Vec<f64> = PHYSICAL.iter().filter_map(|name| value(name)).collect();
        let (machine, ratio): (Referred<f64>, Option<f64>) =
            if let [resistance, inductance, kt, kb, inertia, viscous] = six[..] {
                let physical = Physical {
                    resistance,
                    inductance,
                    kt,
                    kb,
                    inertia,
                    viscous,
                };
                (physical.machine(), Some(resistance / kt))
            } else {
                (responding(&of)?, None)
            };
        let response = machine.response();
        for found in &mut into.parameters {
            match found.name.as_str() {
                "gain" => found.value = response.gain,
                "a1" => found.value = response.a1,
                "electrical_time_constant" => found.value = machine.electrical,
                _ => {}
            }
        }
        for own in &mut into.model.parameters {
            let said = into.parameters.iter().find(|found| found.name == own.name);
            let Some(said) = said else { continue };
            own.value = match (said.unit.as_str(), own.unit.as_str(), ratio) {
                (said_unit, own_unit, _) if said_unit == own_unit => said.value,
                ("N*m", "V", Some(ratio)) => said.value * ratio,
                (said_unit, own_unit, _) => {
                    return Err(Error::Export(format!(
                        "{} is known in {said_unit}, and the model needs it in {own_unit}: fit with the resistance and kt_equals_kb \
                         (or kt) under [known]",
                        own.name
                    )));
                }
            };
        }
        into.model.machine = Machine::from(&machine);
        Ok(())
    }
}

/// The machine of gain, time constants and the viscous part: with `D = 1/gain`, damping `b = p·D`, `m = a1·D − τe·b`.
fn responding(of: &dyn Fn(&str) -> Option<(f64, String)>) -> Result<Referred<f64>, Error> {
    let need = |name: &str| {
        let found = of(name).map(|(value, _)| value);
        found.ok_or_else(|| Error::Export(format!("the population has no {name}")))
    };
    let (gain, a1) = (need("gain")?, need("a1")?);
    let electrical = need("electrical_time_constant").unwrap_or(0.0);
    let part = need("viscous_part").unwrap_or(0.0);
    let total = 1.0 / gain;
    let damping = part * total;
    let machine = Referred {
        kb: total - damping,
        damping,
        inertia: a1 * total - electrical * damping,
        electrical,
    };
    (machine.inertia > 0.0 && total.is_finite())
        .then_some(machine)
        .ok_or_else(|| Error::Export("a drawn motor has no inertia".to_owned()))
}
