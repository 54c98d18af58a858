//! Writer of waveforms in the format VCD (value change dump, IEEE 1364), which GTKWave and Surfer open.

use super::model::{Events, Trace, Track};
use pxpl5_sim::Time;
use std::collections::BTreeMap;
use std::io::{self, Write};
use vcd::{IdCode, SimulationCommand, TimescaleUnit, Value, VarType, Writer};

/// Number of bits of counters and of picture numbers.
const BITS: u32 = 32;

/// Text of a signal while its resource does not work.
const IDLE: &str = "-";

/// A new value of a signal.
enum Change {
    Bit(bool),
    /// `None` is the unknown value `x`.
    Number(Option<i64>),
    Text(String),
}

/// Changes in order of time. At one instant, the last change of a signal counts, as in hardware.
type Changes = BTreeMap<(Time, IdCode), Change>;

/// Writes a trace as a waveform with a resolution of 1 ps, from the time `begin` to the time `end`.
///
/// Each board, surface and video of a display is a scope. A stage or another track of slices has three signals: one is
/// 1 while the resource works, one has the picture's number, and one has the name of the work as a string. Instants are
/// events, and counters are integers.
///
/// # Errors
///
/// Returns any error of the writer `out`.
pub fn vcd(trace: &Trace, [begin, end]: [Time; 2], out: impl Write) -> io::Result<()> {
    let mut out = Writer::new(out);
    for (key, value) in &trace.origin {
        out.comment(&format!("{key}: {value}"))?;
    }
    out.timescale(1, TimescaleUnit::PS)?;
    let mut changes = Changes::new();
    for (group, name) in trace.groups.iter().enumerate() {
        out.add_module(&word(name))?;
        for track in trace.tracks.iter().filter(|track| track.group == group) {
            declare(&mut out, track, begin, &mut changes)?;
        }
        out.upscope()?;
    }
    out.enddefinitions()?;
    write(&mut out, [begin, end], &changes)
}

/// Returns a name without white space, which ends names and strings of the format.
fn word(name: &str) -> String {
    name.replace(char::is_whitespace, "_")
}

fn declare(out: &mut Writer<impl Write>, track: &Track, begin: Time, changes: &mut Changes) -> io::Result<()> {
    let name = word(&track.name);
    match &track.events {
        Events::Slices(slices) => {
            let busy = out.add_wire(1, &name)?;
            let picture = out.add_var(VarType::Integer, BITS, &format!("{name}_picture"), None)?;
            let label = out.add_var(VarType::String, 1, &format!("{name}_name"), None)?;
            let mut set = |time, works, number, name| {
                changes.insert((time, busy), Change::Bit(works));
                changes.insert((time, picture), Change::Number(number));
                changes.insert((time, label), Change::Text(name));
            };
            set(begin, false, None, IDLE.to_owned());
            for slice in slices.iter().filter(|slice| slice.end > slice.begin) {
                let number = slice.picture.and_then(|picture| i64::try_from(picture.0).ok());
                set(slice.begin.max(begin), true, number, word(&slice.name));
                set(slice.end, false, None, IDLE.to_owned());
            }
        }
        Events::Instants(instants) => {
            let signal = out.add_var(VarType::Event, 1, &name, None)?;
            changes.extend(instants.iter().map(|(time, _)| ((*time, signal), Change::Bit(true))));
        }
        Events::Counter(values) => {
            let signal = out.add_var(VarType::Integer, BITS, &name, None)?;
            changes.extend(values.iter().map(|(time, value)| ((*time, signal), Change::Number(Some(*value)))));
        }
    }
    Ok(())
}

fn write(out: &mut Writer<impl Write>, [begin, end]: [Time; 2], changes: &Changes) -> io::Result<()> {
    let mut now = begin;
    out.timestamp(begin.0)?;
    out.begin(SimulationCommand::Dumpvars)?;
    for ((time, signal), change) in changes.iter().take_while(|((time, _), _)| *time <= end) {
        // The values at the beginning are the first of the sorted changes.
        if *time > now {
            if now == begin {
                out.end()?;
            }
            out.timestamp(time.0)?;
            now = *time;
        }
        match change {
            Change::Bit(value) => out.change_scalar(*signal, *value)?,
            Change::Text(text) => out.change_string(*signal, text)?,
            Change::Number(None) => out.change_vector(*signal, [Value::X])?,
            Change::Number(Some(number)) => {
                let bits = (0..BITS).rev().map(|bit| Value::from(number >> bit & 1 == 1));
                out.change_vector(*signal, bits)?;
            }
        }
    }
    if now == begin {
        out.end()?;
    }
    out.flush()
}
