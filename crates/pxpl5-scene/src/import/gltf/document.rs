//! A glTF file: its JSON together with its buffers.

use pxpl5_sim::parameters::FileError;
use serde::Deserialize;

use super::buffers::Buffers;
use super::json::{COMPRESSION, Root, parsed};
use crate::import::Source;

pub(super) struct Document<'a> {
    pub(super) source: &'a Source<'a>,
    pub(super) root: Root<'a>,
    pub(super) buffers: Buffers<'a>,
}

impl<'a> Document<'a> {
    /// Parses the object with the index `number` of a list.
    pub(super) fn object<T: Deserialize<'a>>(&self, list: &str, number: usize) -> Result<T, FileError> {
        let part = format!("{list}[{number}]");
        let items = self.root.list(list);
        match items.get(number) {
            Some(text) => parsed(self.source, &part, text),
            None => {
                let found = format!("{} {list}", items.len());
                Err(self.source.part(part, format!("an item of {list} with this index"), found))
            }
        }
    }

    /// Returns the text that describes missing numbers in an error. If an extension compresses the meshes of the file,
    /// the text names this extension.
    pub(super) fn none(&self) -> String {
        let compressed = self.root.names("extensionsUsed").find(|name| COMPRESSION.contains(&name.as_str()));
        compressed.map_or("none".to_owned(), |name| format!("none in a file that uses {name}"))
    }
}
