//! Measures the speed of whole machines and writes the tables of docs/speed.md and README.md that lie between
//! `<!-- speed: NAME -->` and `<!-- end of speed -->`: nothing of them is typed. `scripts/speed` builds and runs it.
//!
//! Times are CPU time of the process, but where threads are compared. What a table compares is measured in one process, in turns, and the best of some rounds
//! counts: beside other work that is what swings least. `cargo run --release --example speed [-- --check] [-- --opengl PROGRAM]`: the first only
//! measures one round and prints, the second has the program of scripts/llvmpipe draw beside us.

mod cases;
mod cores;
mod opengl;
mod page;
#[path = "../../benches/support/peers.rs"]
#[allow(dead_code, reason = "the bench draws with more arrays")]
mod peers;
mod timing;
mod workers;

use std::error::Error;
use std::path::Path;

/// Rounds of each table.
const ROUNDS: usize = 7;

#[derive(Default)]
struct Options {
    is_check: bool,
    /// The program that draws with the installed OpenGL.
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
    let savings = cases::savings(rounds.min(3))?;
    let threads = workers::table()?;
    let conditions = page::conditions(rounds, &begin);
    let tables = [
        ("goals", format!("{conditions}\n\n{}", page::of_goals(&goals))),
        ("savings", page::of_savings(&savings)),
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
    page::replace(
        Path::new("README.md"),
        "summary",
        &format!("{conditions}\n\n{}", page::of_goals(&cases::chosen(&goals))),
    )
}
