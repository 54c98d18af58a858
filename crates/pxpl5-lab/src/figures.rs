//! Published figures compared with the model: the printed value, the simulated value and their difference.
//!
//! ```text
//!   TOPICS: lists of Measurement (data and one experiment each) --FigureSettings--> FigureRow: published, simulated, error,
//!                                                                          interval, provenance
//! ```
//!
//! A figure is one entry ([`Measurement`]) in the list of its topic: the printed value, its experiment, the definition
//! of its latency, its provenance with the reason, and the parameters that move it. Tables, documents, commands,
//! intervals and the ranking of interpretations read the entries, so a new figure changes one file and ACCURACY.md.
//!
//! All rows come from the same machine parameters. Rows 3, 5 and 6 describe machines with other loads or costs than the
//! presets. The experiments of these rows change only the parameters that the paper's statement changes.
//!
//! Sources: TR94, I3D95, JITP, F89 and others. This project chose the loads of the experiments.

mod alternatives;
mod applications;
mod document;
mod family;
mod groups;
mod headline;
mod heads;
mod interpretation;
mod jitp;
mod measurement;
mod rates;
mod rendering_control;
mod rig_lines;
mod settings;
mod slats;
mod topics;
mod trackers;
mod value;

pub use alternatives::{AlternativeQuery, Alternatives, Effect};
pub use document::{Documents, TIME_MARK, documents};
pub use groups::{FigureGroup, FigureQuery, Figures};
pub use headline::{Counted, Headline};
pub use interpretation::{FieldCount, Interpretation, LatencySamples, ROOM};
pub use measurement::{LatencyDefinition, MISS_PERCENT, Measurement, Varied, has_file};
pub use pxpl5_sim::figures::{Basis, Detail, FigureRow};
pub use rig_lines::PHOTODIODE_LINE;
pub use settings::FigureSettings;
pub use topics::{TOPICS, Topic, all, at_all_levels};
pub(crate) use value::DEVIATION;
pub use value::FigureValue;
