//! Measures the speed of whole machines and writes the tables of docs/speed.md and README.md. The tables lie between
//! `<!-- speed: NAME -->` and `<!-- end of speed -->`, and no number in them is typed by hand. `scripts/speed` builds
//! and runs the program.
//!
//! Times are CPU times of the process, except in comparisons of threads. All values of a table are measured in one
//! process, in turns. The best of several rounds counts, because it varies least under other load.
//!
//! `cargo run --release -p pxpl5-benches [-- --check] [-- --opengl PROGRAM]`: `--check` measures one round and prints
//! only. `--opengl` also measures the program of scripts/llvmpipe.

mod cases;
mod cores;
mod opengl;
mod page;
#[allow(dead_code, reason = "the bench draws with more arrays")]
mod peers;
mod timing;
mod workers;

use std::error::Error;
use std::path::Path;

/// Number of rounds for each table.
const ROUNDS: usize = 7;

#[derive(Default)]
struct Options {
    is_check: bool,
    /// Program that draws with the installed OpenGL.
    opengl: Option<String>,
}

impl Options {
    fn read(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut options = Self::default();
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--check" => options.is_check = true,
                "--opengl" => {
                    options.opengl = Some(arguments.next().ok_or("--opengl: expected a program, found nothing")?)
                }
                _ => return Err(format!("expected --check or --opengl PROGRAM, found {argument}")),
            }
        }
        Ok(options)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let Options { is_check, opengl } = Options::read(std::env::args().skip(1))?;
    let rounds = if is_check { 1 } else { ROUNDS };
    let begin = page::load_average();
    let goals = cases::goals(rounds, opengl.as_deref())?;
    let optimizations = cases::optimizations(rounds.min(3))?;
    let threads = workers::table()?;
    let conditions = page::conditions(rounds, &begin);
    let tables = [
        ("goals", format!("{conditions}\n\n{}", page::of_goals(&goals))),
        ("optimizations", page::of_optimizations(&optimizations)),
        ("threads", threads),
        ("cores", cores::table(rounds.min(3))?),
    ];
    if is_check {
        for (name, table) in &tables {
            println!("{name}\n{table}");
        }
        return Ok(());
    }
    for (name, table) in &tables {
        page::replace(Path::new("docs/speed.md"), name, table)?;
    }
    page::replace(Path::new("README.md"), "summary", &page::of_summary(&goals))
}
