//! Assembled programs, which are kept for all later uses.

use i860::Program;
use std::collections::HashMap;
use std::hash::Hash;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

pub(crate) type Programs<K> = LazyLock<Mutex<HashMap<K, Arc<Program>>>>;

pub(crate) fn kept<K: Copy + Eq + Hash>(
    programs: &Programs<K>,
    kernel: K,
    assembled: impl FnOnce(K) -> Program,
) -> Arc<Program> {
    let mut programs = programs.lock().unwrap_or_else(PoisonError::into_inner);
    Arc::clone(programs.entry(kernel).or_insert_with(|| Arc::new(assembled(kernel))))
}
