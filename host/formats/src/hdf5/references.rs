//! What references of MATLAB lead to: the members of one group.

use hdf5_reader::group::Group;
use hdf5_reader::{Dataset, Hdf5File};
use std::collections::HashMap;

/// The group that MATLAB keeps them in.
pub(super) const REFERENCES: &str = "#refs#";
/// Members of it.
const MOST: usize = 1 << 17;

/// The members of that group by their addresses.
#[derive(Default)]
pub(super) struct References {
    group: Option<Group>,
    members: HashMap<u64, Member>,
}

struct Member {
    name: String,
    is_group: bool,
}

/// What a reference leads to.
pub(super) enum Object {
    /// A group.
    Group(Group),
    /// A dataset.
    Dataset(Box<Dataset>),
}

impl References {
    /// Those of a file.
    pub(super) fn of(file: &Hdf5File) -> Option<Self> {
        let group = file.root_group().ok()?.group(REFERENCES).ok()?;
        let (groups, datasets) = group.member_names().ok()?;
        let groups = groups.into_iter().filter_map(|name| {
            let address = group.group(&name).ok()?.address();
            let is_group = true;
            Some((address, Member { name, is_group }))
        });
        let datasets = datasets.into_iter().filter_map(|name| {
            let address = group.dataset(&name).ok()?.address();
            let is_group = false;
            Some((address, Member { name, is_group }))
        });
        let members = groups.chain(datasets).take(MOST).collect();
        Some(References {
            group: Some(group),
            members,
        })
    }

    /// What the reference `address` leads to.
    pub(super) fn get(&self, address: u64) -> Option<Object> {
        let group = self.group.as_ref()?;
        let member = self.members.get(&address)?;
        Some(if member.is_group {
            Object::Group(group.group(&member.name).ok()?)
        } else {
            Object::Dataset(Box::new(group.dataset(&member.name).ok()?))
        })
    }
}
