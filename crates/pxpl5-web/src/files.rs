//! Files that a visitor has added to the page.

use std::collections::BTreeMap;
use std::sync::Arc;
use wasm_bindgen::prelude::wasm_bindgen;

/// Contents of the files that settings may name: models (PLY, OBJ, PDB) and recordings of a head.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Files(pub(crate) BTreeMap<String, Arc<[u8]>>);

#[wasm_bindgen]
impl Files {
    /// Creates an empty set of files.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file, or replaces the file of the same name.
    pub fn add(&mut self, name: &str, contents: &[u8]) {
        self.0.insert(name.to_owned(), contents.into());
    }
}
