//! Files that a visitor of the page has added.

use std::collections::BTreeMap;
use std::sync::Arc;
use wasm_bindgen::prelude::wasm_bindgen;

/// Names and contents of files for an experiment: models (PLY, OBJ, PDB) and recorded head motions.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Files(pub(crate) BTreeMap<String, Arc<[u8]>>);

#[wasm_bindgen]
impl Files {
    /// Creates an empty set of files.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file. A file with the same name is replaced.
    pub fn add(&mut self, name: &str, contents: &[u8]) {
        self.0.insert(name.to_owned(), contents.into());
    }
}
