//! Writes the papers' figures beside ours, and all pictures: `arp [--write FILE.md] [--out FOLDER]`.

use pxpl5_arp::figures;
use pxpl5_arp::pictures::{self, Picture};
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (experiments, rows) = figures::all()?;
    for pair in arguments.chunks(2) {
        match pair {
            [option, file] if option == "--write" => std::fs::write(file, figures::markdown(&experiments, &rows))?,
            [option, folder] if option == "--out" => write(Path::new(folder), pictures::all(&experiments)?)?,
            other => return Err(format!("expected --write FILE.md or --out FOLDER, found {other:?}").into()),
        }
    }
    if arguments.is_empty() {
        print!("{}", figures::markdown(&experiments, &rows));
    }
    Ok(())
}

fn write(folder: &Path, all: Vec<Picture>) -> Result<(), Box<dyn Error>> {
    std::fs::create_dir_all(folder)?;
    for picture in all {
        match picture {
            Picture::Pixels(name, pixels) => pixels.save(folder.join(name + ".png"))?,
            Picture::Drawing(name, text) => std::fs::write(folder.join(name + ".svg"), text)?,
        }
    }
    Ok(())
}
