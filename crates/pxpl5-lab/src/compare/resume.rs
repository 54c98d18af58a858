//! Opens the folder with the finished rows of a comparison, and checks that the rows have the settings of this
//! comparison.

use super::query::CompareQuery;
use super::store::{CompareStore, Header, ROWS_SCHEMA};
use crate::error::StudyError;
use crate::experiment_file::plain;
use crate::sweep::inputs_of;
use pxpl5_run::Fingerprint;
use std::collections::BTreeMap;
use std::path::Path;

impl CompareQuery {
    /// Opens or creates the folder of finished rows. If `resume` is true, the finished rows are kept. Otherwise, the
    /// rows of a complete comparison are deleted.
    ///
    /// # Errors
    ///
    /// Returns [`StudyError`] in these cases:
    ///
    /// - The folder cannot be read or written, or is in use.
    /// - A line of the file of rows is damaged, and is not the last line.
    /// - `resume` is true, and the folder holds rows with other settings. The error names the first key that differs.
    /// - `resume` is false, and the folder holds rows of an interrupted comparison.
    /// - A setting of the query is invalid.
    pub fn open_store(&self, folder: &Path, resume: bool) -> Result<CompareStore, StudyError> {
        CompareStore::open(folder, &self.header()?, resume)
    }

    pub(super) fn header(&self) -> Result<Header, StudyError> {
        let (plan, rows) = self.identity()?;
        // The seeds of the query replace the seed of the settings.
        let shared = self.shared.settings.iter().filter(|(key, _)| *key != "seed");
        let mut settings: BTreeMap<String, String> =
            shared.map(|(key, setting)| (key.clone(), plain(&setting.value))).collect();
        let mut put = |key: &str, value: String| drop(settings.insert(key.to_owned(), value));
        // The query's own settings have the names of its fields.
        put("seeds", format!("{:?}", self.seeds));
        put("limits", self.limits.to_string());
        put("causes", self.causes.to_string());
        put("predictors", self.predictors.to_string());
        put("confidence", self.confidence.to_string());
        put("until_precision", self.until.map_or_else(|| "none".to_owned(), |until| until.width.to_string()));
        put("max_seeds", self.until.map_or_else(|| "none".to_owned(), |until| until.max_seeds.to_string()));
        put("pictures", self.pictures.to_string());
        // Hash the contents of the scene count, because the file of a model file can refer to other files.
        put("contents of the scene", Fingerprint::of_scene(&*plan.load_scene()?).to_string());
        for (name, contents) in inputs_of(&self.shared) {
            put(&format!("contents of {name}"), contents.to_string());
        }
        let (schema, version) = (ROWS_SCHEMA.to_owned(), env!("CARGO_PKG_VERSION").to_owned());
        Ok(Header { schema, version, rows, settings, config_hash: plan.fingerprint().to_string() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::RowChoice;
    use crate::experiment_file::ExperimentFile;
    use crate::study::Study;
    use crate::study::tests::StopsAfter;
    use std::sync::Arc;

    #[test]
    fn a_stopped_comparison_stores_no_row_of_stopped_runs_and_can_be_resumed() {
        let text = "scene = \"full-screen:2\"\nfields = 24\nmachine.preset = \"small-hmd\"\n\
                    head.motion = \"synthetic\"\nhead.tracker = \"optical\"\n";
        let query = CompareQuery {
            only: RowChoice::Named(vec!["slats".to_owned(), "ideal".to_owned()]),
            seeds: vec![1, 2],
            ..CompareQuery::new(ExperimentFile::parse(text, "test").expect("TOML"))
        };
        let folder = tempfile::tempdir().expect("a folder");
        // The first finished run stops the comparison, so each row has at least one run without a result.
        let mut watcher = StopsAfter { parts: 1, ..StopsAfter::default() };
        let opened = || query.open_store(folder.path(), true).map(Arc::new).expect("a folder");
        let stopped = CompareQuery { store: Some(opened()), ..query.clone() }.run(&mut watcher);
        assert!(matches!(stopped, Err(StudyError::Experiment(pxpl5_run::ExperimentError::Stopped(_)))), "{stopped:?}");
        assert_eq!(watcher.rows, 0);
        let store = opened();
        assert_eq!(store.found(), 0);
        let resumed = CompareQuery { store: Some(store), ..query.clone() }.run(&mut ()).expect("it runs");
        assert_eq!(resumed.pipelines.len(), 2);
    }
}
