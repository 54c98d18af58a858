//! A parsed glTF file with its buffers.

use gltf_json::Root;

use super::buffers::Buffers;
use crate::import::Source;

/// Extensions that compress meshes, so that the file has no plain numbers.
pub(super) const COMPRESSION: [&str; 3] =
    ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"];

pub(super) struct Document<'a> {
    pub(super) source: &'a Source<'a>,
    pub(super) root: Root,
    pub(super) buffers: Buffers<'a>,
}

impl Document<'_> {
    /// Returns the text that describes missing numbers in an error. If an extension compresses the meshes of the file,
    /// the text names this extension.
    pub(super) fn none(&self) -> String {
        let compressed = self.root.extensions_used.iter().find(|name| COMPRESSION.contains(&name.as_str()));
        compressed.map_or("none".to_owned(), |name| format!("none in a file that uses {name}"))
    }
}
