//! Machines, their boards and displays, their parameters, and records of their boards during a run.

/// A description of the machine on which an experiment runs.
///
/// The example adds boards to the machine of TR94, makes its ring slower, and reads the source of a parameter.
///
/// ```
/// use pxpl5::{MachineConfig, Parameter};
///
/// let mut machine = MachineConfig::small_hmd().with_gps(20).with_renderers(8);
/// machine.set("ring.word_ns", 100)?;
/// machine.check()?;
/// // Every parameter has a unit, a provenance and a source.
/// let word: Option<Parameter> = machine.parameters().into_iter().find(|parameter| parameter.path == "ring.word_ns");
/// assert!(word.is_some_and(|word| word.info.unit == "ns" && word.info.source.starts_with("TR94")));
/// # Ok::<(), pxpl5::SettingError>(())
/// ```
pub use pxpl5_machine::MachineConfig;

/// Lists of the arrivals, the swaps and further events of a run.
///
/// In the example, each picture of an eye has 20 regions, and no region arrives too late.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{Arrival, LateRegion, Observation, Shown, StageSpan, Swap};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let outcome = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60).run()?;
/// let observed: &Observation = outcome.observation();
/// let (arrivals, swaps): (&[Arrival], &[Swap]) = (&observed.arrivals, &observed.swaps);
/// assert!(arrivals.len() >= 20 && swaps.len() >= 2);
/// let stages: Vec<StageSpan> = outcome.stages();
/// assert!(stages.iter().all(|stage| stage.end.is_none_or(|end| end >= stage.begin)));
/// // The pictures that one frame buffer showed, and the regions that arrived too late.
/// let shown: Vec<Shown> = outcome.record().shown_by(swaps[0].port);
/// let late: &[LateRegion] = &outcome.tally().first_late_regions;
/// assert!(!shown.is_empty() && late.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_machine::Observation;

/// The name of a board, which can be printed and parsed.
///
/// The example prints a board, parses a board, and reads an error message.
///
/// ```
/// use pxpl5::{Board, SettingError};
///
/// assert_eq!(Board::Renderer(3).to_string(), "renderer 3");
/// assert_eq!("gp 12".parse(), Ok(Board::Gp(12)));
/// let error: SettingError = "gpu 1".parse::<Board>().expect_err("no board");
/// println!("{error}");
/// ```
pub use pxpl5_machine::Board;

/// A record of all messages on the ring, which an experiment makes on request.
///
/// The example prints the first message. The same messages are events of the outcome.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{Traffic, Transfer};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(30);
/// let outcome = experiment.record_traffic(true).run()?;
/// let traffic: &Traffic = outcome.observation().traffic.as_deref().ok_or("traffic was recorded")?;
/// let ports = outcome.record().ports();
/// let Transfer { source, destination, words, .. } = traffic.transfers[0];
/// println!("{} sends {words} words to {}", ports.board(source), ports.board(destination));
/// assert!(outcome.events().any(|event| matches!(event.kind, ObservedKind::Message { .. })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_machine::Traffic;

/// A machine with loaded programs, without an experiment around it.
///
/// The example prints the first event, and runs the machine for one microsecond.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{EventDescription, Machine, Record};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(3);
/// let mut machine: Machine = experiment.build()?;
/// let next: EventDescription = machine.next_event_description().ok_or("a machine that was started")?;
/// println!("{next}");
/// machine.step_before(pxpl5::Time(1_000_000))?;
/// let record: Record = machine.into_record();
/// assert!(record.events() <= 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_machine::Machine;

/// The error of a machine that cannot continue, such as a deadlock.
///
/// The example makes the error of a deadlock, which names the waiting boards.
///
/// ```
/// use pxpl5::{Blocked, Board, RunError, Time};
///
/// let wait = Blocked { board: Board::Renderer(3), waits_on: Some(Board::Display(0)), waits_for: "a port".to_owned() };
/// assert_eq!(wait.to_string(), "renderer 3 waits for a port");
/// let error = RunError::Deadlock { time: Time(0), blocked: vec![wait] };
/// assert_eq!(error.blocked()[0].waits_on, Some(Board::Display(0)));
/// ```
pub use pxpl5_machine::RunError;

/// A part of the simulator that saves computing time and changes no result.
///
/// The example compares two runs, with and without an optimization.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::Optimization;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(12);
/// let slow = experiment.clone().without(Optimization::Transfers).run()?;
/// assert_eq!(slow.record().trace_hash(), experiment.run()?.record().trace_hash());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_machine::Optimization;

/// A list of named parameters, each with the origin of its value.
///
/// The example reads the time of a word on the ring.
///
/// ```
/// use pxpl5::{MachineConfig, ParameterInfo, ParameterTable, Provenance, Value};
///
/// let machine = MachineConfig::small_hmd();
/// // An entry of a table can also be read by its name. Each entry has the origin of its value.
/// let word: &ParameterInfo = machine.ring.entries()[0].info;
/// assert_eq!(machine.ring.get(word.name)?, word.papers);
/// assert_eq!("published".parse(), Ok(Provenance::Published));
/// assert_eq!(Value::Whole(50).to_string(), "50");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_sim::parameters::ParameterTable;

/// The error of functions that read settings.
///
/// The example reads the errors of an unknown key, an unknown name and a malformed text.
///
/// ```
/// use pxpl5::{Board, ExperimentFile, Level, MachineConfig, SettingError, SettingErrorKind};
///
/// let key: SettingError = ExperimentFile::parse("pipelin = \"slats\"\n", "mine.toml").expect_err("no such key");
/// assert_eq!(key.to_string(), "mine.toml, line 1: there is no key `pipelin`; did you mean `pipeline`?");
/// // For an unknown name, the error has the nearest valid name. For a malformed text, it has the expected form.
/// let name: SettingError = "cicle".parse::<Level>().expect_err("no level");
/// assert_eq!((name.kind, &*name.nearest), (SettingErrorKind::UnknownName, "cycle"));
/// let text: SettingError = "gpu".parse::<Board>().expect_err("no board");
/// assert!(text.expected.starts_with("host, ring"));
/// ```
pub use pxpl5_sim::parameters::SettingError;

/// The error of functions that read scenes and other files.
///
/// The example reads a scene with a syntax error.
///
/// ```
/// use pxpl5::{FileError, FileErrorKind, scene};
///
/// let error: FileError = scene::from_bytes(b"v 0 0 x\n", scene::Format::Obj, "a.obj").expect_err("no number");
/// assert_eq!((error.kind, &*error.place), (FileErrorKind::Syntax, "line 1"));
/// ```
pub use pxpl5_sim::parameters::FileError;

/// Access to settings by their paths, as in files and options.
///
/// The example changes a setting of a volumetric display. The error for an unknown path contains the nearest path.
///
/// ```
/// # #[cfg(feature = "volume")] {
/// use pxpl5::{PathSettings, volume::VolumeSettings};
///
/// let mut settings = VolumeSettings::paper();
/// settings.assign("clip.variant = hyperbolic", "--set")?;
/// let error = settings.set("clip.varient", "hyperbolic", "--set").expect_err("no such path");
/// assert!(error.to_string().contains("clip.variant"), "{error}");
/// # }
/// # Ok::<(), pxpl5::SettingError>(())
/// ```
pub use pxpl5_sim::parameters::PathSettings;

/// A complete machine that is selected by name.
///
/// The example reads the description of a machine of the papers, and parses a version of its code.
///
/// ```
/// use pxpl5::{CodeVersion, PRESETS, Preset};
///
/// let preset: Preset = "small-hmd".parse()?;
/// assert!(PRESETS.contains(&preset) && preset.about.contains("TR94"));
/// assert_eq!("scheduled".parse(), Ok(CodeVersion::Scheduled));
/// # Ok::<(), pxpl5::SettingError>(())
/// ```
pub use pxpl5_machine::Preset;

/// An OLED display of a headset, in place of NTSC displays.
///
/// The example adds this display to a machine, and lists the names of five displays.
///
/// ```
/// use pxpl5::{FrameBufferConfig, HiResConfig, LcdConfig, MachineConfig, NtscDisplay, OledConfig, Panel, PanelConfig};
///
/// let machine = MachineConfig::small_hmd().with_display(OledConfig::PAPERS);
/// assert!(machine.check().is_ok());
/// let names = [
///     machine.displays[0].name(),
///     pxpl5::device::DisplayConfig::name(&HiResConfig::PAPERS),
///     pxpl5::device::DisplayConfig::name(&LcdConfig::PAPERS),
///     pxpl5::device::DisplayConfig::name(&PanelConfig::PAPERS),
///     pxpl5::device::DisplayConfig::name(&FrameBufferConfig::NTSC),
/// ];
/// assert_eq!(names, ["oled-90", "hires", "lcd-120", "panel", "ntsc"]);
/// // A panel is described by numbers.
/// let numbers = pxpl5::PanelNumbers::of(&OledConfig::PAPERS);
/// assert!(numbers.check("oled").is_ok());
/// # let _: (Option<Panel>, Option<NtscDisplay>) = (None, None);
/// ```
pub use pxpl5_framebuffer::OledConfig;

/// A point on the clock of the machine, as a whole number of picoseconds.
///
/// The example computes with times, and parses a hash of a run.
///
/// ```
/// use pxpl5::{Span, Time, TraceHash};
///
/// let begin = Time(0) + Span::from_us(3);
/// assert_eq!(begin.since(Time(1_000_000)), Span::from_us(2));
/// assert_eq!("00000000000000ff".parse(), Ok(TraceHash(255)));
/// ```
pub use pxpl5_sim::Time;

/// A number for each picture that a viewer can see, such as the picture of an eye.
///
/// On the machine of the example, each surface is the picture of an eye.
///
/// ```
/// use pxpl5::{Eye, PeriodNumber, PictureNumber, SurfaceId, ViewNumber};
///
/// assert_eq!(SurfaceId::from(Eye::Right), SurfaceId(1));
/// assert_eq!("right".parse(), Ok(Eye::Right));
/// assert_eq!(PeriodNumber(3).next(), PeriodNumber(4));
/// // Pictures and views have numbers, which can be compared.
/// assert!(PictureNumber(1) < PictureNumber(2) && ViewNumber(1) < ViewNumber(2));
/// ```
pub use pxpl5_wire::SurfaceId;

pub use pxpl5_framebuffer::{FrameBufferConfig, HiResConfig, LcdConfig, NtscDisplay, Panel, PanelConfig, PanelNumbers};
pub use pxpl5_gp::CodeVersion;
pub use pxpl5_machine::{
    Arrival, Blocked, EventDescription, LateRegion, ObservedEvent, ObservedKind, PRESETS, Ports, Record, Shown,
    StageSpan, Swap, Transfer,
};
pub use pxpl5_sim::parameters::{FileErrorKind, Parameter, ParameterInfo, Provenance, SettingErrorKind, Value};
pub use pxpl5_sim::{Span, TraceHash};
pub use pxpl5_wire::{Eye, PeriodNumber, PictureNumber, ViewNumber};
