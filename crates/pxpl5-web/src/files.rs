//! Files that a visitor has handed in.

use std::collections::BTreeMap;
use std::sync::Arc;
use wasm_bindgen::prelude::wasm_bindgen;

/// Contents of files that settings may name: models (PLY, OBJ, PDB) and recordings of a head.
#[wasm_bindgen]
#[derive(Debug, Default)]
pub struct Files(pub(crate) BTreeMap<String, Arc<[u8]>>);

#[wasm_bindgen]
impl Files {
    /// No files.
    #[wasm_bindgen(constructor)]
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Has a file of this name.
    pub fn add(&mut self, name: &str, contents: &[u8]) {
        self.0.insert(name.to_owned(), contents.into());
    }
}
