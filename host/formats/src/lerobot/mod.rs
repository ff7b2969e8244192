//! A dataset of LeRobot: a folder of Parquet files, of which each episode is a table.

mod episodes;
mod info;

use crate::batch::{Each, Start, asked, place};
use crate::detect::Format;
use crate::error::{FormatError, FormatFault};
use crate::log::{Column, Kind, Log, Rows, Table};
use crate::parquet::{MOST_COLUMNS_OF_ALL, ParquetFile, Part, Source, Step, in_batch};
use ::parquet::file::statistics::Statistics;
use arrow_array::BooleanArray;
use arrow_schema::DataType;
use arrow_select::filter::filter_record_batch;
use episodes::{Episode, column, episodes};
use info::{Info, Place, damaged};
use std::ops::ControlFlow;
use std::path::Path;

/// A dataset. Its files are opened one at a time, when an episode is read.
pub(crate) struct LeRobot {
    source: String,
    tables: Vec<Table>,
    episodes: Vec<Episode>,
    places: Vec<Place>,
}

/// Whether a folder is such a dataset.
pub(crate) fn is_dataset(folder: &Path) -> bool {
    folder.join("meta").join("info.json").is_file()
}

impl LeRobot {
    pub(crate) fn open(root: &Path) -> Result<Self, FormatError> {
        let source = root.display().to_string();
        let info = Info::read(&root.join("meta").join("info.json"))?;
        let (columns, places): (Vec<Column>, Vec<Place>) = info.columns().into_iter().unzip();
        let episodes = episodes(root, &info)?;
        if episodes.len().saturating_mul(columns.len()) > MOST_COLUMNS_OF_ALL {
            let fault = FormatFault::Unsupported {
                what: format!("a dataset of {} episodes", episodes.len()),
                remedy: "split it with LeRobot".to_owned(),
            };
            return Err(FormatError::new(&source, "", fault));
        }
        let table = |episode: &Episode| Table {
            name: format!("episode {}", episode.index),
            rows: episode.rows,
            columns: columns.clone(),
        };
        Ok(LeRobot {
            tables: episodes.iter().map(table).collect(),
            source,
            episodes,
            places,
        })
    }
}

impl Log for LeRobot {
    fn format(&self) -> Format {
        Format::LeRobot
    }

    fn tables(&self) -> &[Table] {
        &self.tables
    }

    fn read(
        &mut self,
        table: usize,
        columns: &[usize],
        each: &mut dyn FnMut(Rows<'_>) -> ControlFlow<()>,
    ) -> Result<(), FormatError> {
        let found = asked(&self.source, &self.tables, table, columns)?;
        let Some(episode) = self.episodes.get(table) else {
            return Ok(());
        };
        if columns.is_empty() {
            return Ok(());
        }
        let file = ParquetFile::open(&episode.path)?;
        let mut wanted = Vec::with_capacity(columns.len());
        for &column in columns {
            let (Some(column), Some(at)) = (found.columns.get(column), self.places.get(column))
            else {
                continue;
            };
            let Some(source) = source_of(&file, at) else {
                let why = format!("it has no column {} of that shape", at.feature);
                let place = place(&found.name, &column.name);
                return Err(FormatError::new(file.source(), place, damaged(why)));
            };
            wanted.push((source, column.kind));
        }
        let mut broken = false;
        let mut handed = 0_u64;
        rows(&file, episode.index, &wanted, &mut |rows| {
            handed += rows.first().map_or(0, Vec::len) as u64;
            let flow = each(rows);
            broken = flow.is_break();
            flow
        })?;
        // Rows that are lost must not pass for an episode that was short.
        match episode.rows.filter(|said| *said != handed && !broken) {
            None => Ok(()),
            Some(said) => {
                let why = format!("it has {handed} rows of the episode, and meta says {said}");
                let name = found.name.clone();
                Err(FormatError::new(file.source(), name, damaged(why)))
            }
        }
    }
}

/// Where the values of a column are in a file.
fn source_of(file: &ParquetFile, place: &Place) -> Option<Source> {
    let (root, field) = file.schema().column_with_name(&place.feature)?;
    let (mut kind, mut steps) = (field.data_type(), Vec::new());
    // A feature of one element is a list in some datasets, and a number in others.
    let mut left = place.steps.iter();
    while let DataType::List(item) | DataType::LargeList(item) | DataType::FixedSizeList(item, _) =
        kind
    {
        steps.push(left.next().copied().unwrap_or(Step::Element(0)));
        kind = item.data_type();
    }
    left.next().is_none().then_some(Source { root, steps })
}

/// Hands on the rows of an episode.
fn rows(
    file: &ParquetFile,
    episode: u64,
    wanted: &[(Source, Kind)],
    each: Each<'_>,
) -> Result<(), FormatError> {
    let index = column(file, "episode_index").map(|root| Source {
        root,
        steps: Vec::new(),
    });
    let mut roots: Vec<usize> = wanted.iter().map(|(source, _)| source.root).collect();
    roots.extend(index.as_ref().map(|source| source.root));
    roots.sort_unstable();
    roots.dedup();
    let part = Part {
        groups: index
            .as_ref()
            .map(|index| groups(file, index.root, episode)),
        ..Part::default()
    };
    let mut starts = vec![Start::default(); wanted.len()];
    file.read(&roots, part, &mut |batch| {
        let mut batch = batch.clone();
        if let Some(index) = &index {
            let numbers = in_batch(&batch, &roots, index, &mut Start::default())?;
            let own = numbers.iter().map(|number| Some(*number == episode as f64));
            batch = filter_record_batch(&batch, &own.collect::<BooleanArray>())?;
        }
        if batch.num_rows() == 0 {
            return Ok(ControlFlow::Continue(()));
        }
        let mut out = Vec::with_capacity(wanted.len());
        for ((source, kind), start) in wanted.iter().zip(&mut starts) {
            let mut values = in_batch(&batch, &roots, source, &mut Start::default())?;
            if *kind == Kind::Time {
                for seconds in &mut values {
                    *seconds = start.since_seconds(*seconds);
                }
            }
            out.push(values);
        }
        Ok(each(&out))
    })
}

/// The row groups that may have rows of an episode: each has but some of them, and says which.
fn groups(file: &ParquetFile, root: usize, episode: u64) -> Vec<usize> {
    let may_have = |number: &usize| {
        let group = file.groups().get(*number);
        let column = group.and_then(|group| {
            let name = file.schema().fields().get(root)?.name();
            let mut columns = group.columns().iter();
            columns.find(|column| column.column_path().parts() == [name.as_str()])
        });
        let (least, most) = match column.and_then(|column| column.statistics()) {
            Some(Statistics::Int64(said)) => (said.min_opt().copied(), said.max_opt().copied()),
            Some(Statistics::Int32(said)) => (
                said.min_opt().map(|number| i64::from(*number)),
                said.max_opt().map(|number| i64::from(*number)),
            ),
            _ => (None, None),
        };
        let episode = i64::try_from(episode).unwrap_or(i64::MAX);
        least.is_none_or(|least| least <= episode) && most.is_none_or(|most| episode <= most)
    };
    (0..file.groups().len()).filter(may_have).collect()
}
