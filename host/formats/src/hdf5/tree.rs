//! Groups as variables.

use super::references::{Object, REFERENCES, References};
use super::stored::Stored;
use crate::matlab::{Fields, Value};
use hdf5_reader::group::Group;
use hdf5_reader::reference::read_object_references;
use hdf5_reader::{Dataset, Datatype, Hdf5File};
use std::collections::HashSet;

/// Depth to which groups are nested.
const DEEPEST: usize = 32;
/// Groups and datasets.
const MOST_PARTS: usize = 1 << 17;
/// Letters of a text, or references of a struct array.
pub(super) const MOST_ELEMENTS: u64 = 1 << 16;
/// The group that MATLAB keeps its objects in.
const OBJECTS: &str = "#subsystem#";
/// The attribute that says what MATLAB knows a dataset as.
pub(super) const CLASS: &str = "MATLAB_class";

/// Walks through a file.
pub(crate) struct Tree {
    /// Datasets that hold rows.
    pub(crate) stored: Vec<Stored>,
    /// Whether MATLAB wrote the file, so that its axes are in the opposite order.
    pub(super) is_matlab: bool,
    /// Bytes of the file.
    pub(super) bytes: u64,
    references: References,
    visited: HashSet<u64>,
    parts: usize,
}

/// What a group or dataset is to MATLAB.
pub(super) fn class(
    attribute: hdf5_reader::error::Result<hdf5_reader::Attribute>,
) -> Option<String> {
    attribute.ok()?.read_string().ok()
}

impl Tree {
    /// A walk through `file`, which has so many bytes.
    pub(crate) fn new(file: &Hdf5File, bytes: u64, is_matlab: bool) -> Self {
        let references = is_matlab.then(|| References::of(file)).flatten();
        Tree {
            stored: Vec::new(),
            is_matlab,
            bytes,
            references: references.unwrap_or_default(),
            visited: HashSet::new(),
            parts: 0,
        }
    }

    /// The members of a group as fields.
    pub(crate) fn fields(&mut self, group: &Group) -> hdf5_reader::error::Result<Fields> {
        self.group(group, DEEPEST)
    }

    fn group(&mut self, group: &Group, depth: usize) -> hdf5_reader::error::Result<Fields> {
        let mut members = Fields::new();
        // A link may lead back to a group that holds it.
        let is_new = self.visited.insert(group.address());
        let Some(depth) = depth.checked_sub(1).filter(|_| is_new) else {
            return Ok(members);
        };
        let (mut groups, mut datasets) = group.member_names()?;
        // The order of a file depends on how its links are stored.
        groups.sort();
        datasets.sort();
        for name in datasets {
            let value = match group.dataset(&name) {
                Ok(dataset) => self.dataset(dataset, depth),
                Err(error) => unread(&error),
            };
            members.push((name, value));
        }
        for name in groups {
            if name == REFERENCES || name == OBJECTS {
                continue;
            }
            let value = match group.group(&name) {
                Ok(inner) => self.inner(&inner, depth),
                Err(error) => unread(&error),
            };
            members.push((name, value));
        }
        Ok(members)
    }

    fn inner(&mut self, group: &Group, depth: usize) -> Value {
        if self.is_full() {
            return Value::Nothing;
        }
        if let Some(elements) = self.struct_array(group, depth) {
            return Value::Struct(elements);
        }
        match self.group(group, depth) {
            Ok(fields) => Value::Struct(vec![fields]),
            Err(error) => unread(&error),
        }
    }

    /// Counts another part, and says whether there are too many.
    pub(super) fn is_full(&mut self) -> bool {
        self.parts += 1;
        self.parts > MOST_PARTS
    }

    /// The elements of a struct array: each field is a list of references.
    fn struct_array(&mut self, group: &Group, depth: usize) -> Option<Vec<Fields>> {
        let depth = depth.checked_sub(1).filter(|_| self.is_matlab)?;
        let (groups, mut names) = group.member_names().ok()?;
        names.sort();
        if !groups.is_empty() || names.is_empty() {
            return None;
        }
        let mut elements: Vec<Fields> = Vec::new();
        for name in names {
            let dataset = group.dataset(&name).ok()?;
            let is_list = matches!(dataset.dtype(), Datatype::Reference { .. });
            if !is_list || dataset.attribute(CLASS).is_ok() {
                return None;
            }
            for (at, value) in self.referred(&dataset, depth)?.into_iter().enumerate() {
                if elements.len() <= at {
                    elements.push(Fields::new());
                }
                elements.get_mut(at)?.push((name.clone(), value));
            }
        }
        Some(elements)
    }

    /// What a list of references leads to.
    pub(super) fn referred(&mut self, dataset: &Dataset, depth: usize) -> Option<Vec<Value>> {
        if dataset.num_elements().ok()? > MOST_ELEMENTS {
            return None;
        }
        let bytes = dataset.read_raw_bytes().ok()?;
        let addresses = read_object_references(&bytes, 8).ok()?;
        // A list may lead back to itself.
        self.parts = self.parts.saturating_add(addresses.len());
        if self.parts > MOST_PARTS {
            return None;
        }
        let mut values = Vec::new();
        for address in addresses {
            values.push(match self.references.get(address) {
                Some(Object::Group(group)) => self.inner(&group, depth),
                Some(Object::Dataset(dataset)) => self.dataset(*dataset, depth),
                None => Value::Nothing,
            });
        }
        Some(values)
    }
}

fn unread(error: &hdf5_reader::error::Error) -> Value {
    Value::unread(
        format!("a part that is damaged or unusual ({error})"),
        "save it again, for instance with h5py or `h5repack`",
    )
}
