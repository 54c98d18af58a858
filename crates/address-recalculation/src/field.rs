//! One field of the display, whose pixels are computed only when the picture is read.

use crate::address::{AddressUnit, Footprint};
use crate::config::ArpConfig;
use crate::lens::LensTable;
use crate::lookup::{Addressing, Lookup, LookupStats};
use crate::memory::{MemoryKind, Regions};
use crate::orientation::{MatrixWords, OrientationLatch};
use crate::protocol::region_grid;
use crate::scan::{FaceScan, Latch};
use crate::texel::FaceSet;
use image::{Rgb, RgbImage};
use pxpl5_wire::{FieldParity, PeriodNumber};
use std::sync::{Arc, OnceLock};

#[derive(Debug)]
pub(crate) struct Optics {
    pub(crate) config: ArpConfig,
    /// Table of viewing vectors, one for each pixel. The table is computed when a field is first read.
    pub(crate) table: OnceLock<LensTable>,
    pub(crate) scan: FaceScan,
}

impl Optics {
    /// Returns the table of viewing vectors. No error is possible, because the lens was checked when the display was
    /// built.
    fn table(&self) -> &LensTable {
        let ArpConfig { lens, timing, .. } = &self.config;
        self.table.get_or_init(|| LensTable::of_checked(lens, &self.config.picture(), timing.vector_bits))
    }
}

/// The buffers that were visible in the memories of one eye. The background memory is last.
#[derive(Clone, Debug)]
pub(crate) struct ShownBuffers {
    pub(crate) memories: Vec<(MemoryKind, Arc<Regions>)>,
}

/// Consecutive pixels of a line that share one orientation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Run {
    x: u32,
    y: u32,
    count: u32,
    matrix: MatrixWords,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Field<'a> {
    pub(crate) optics: &'a Optics,
    pub(crate) latch: &'a OrientationLatch,
    pub(crate) shown: &'a ShownBuffers,
    pub(crate) number: PeriodNumber,
}

impl Field<'_> {
    /// Returns the matrix with which a pixel is computed, or `None` if the field does not scan the pixel.
    pub(crate) fn matrix(&self, x: u32, y: u32) -> Option<MatrixWords> {
        let latch = self.optics.config.latch;
        Some(self.latch.at(self.optics.scan.latches(latch, x, y, self.number)?))
    }

    pub(crate) fn footprint(&self, x: u32, y: u32) -> Option<Footprint> {
        let turned = self.matrix(x, y)?.turn(self.optics.table().entry(x, y));
        AddressUnit::new(&self.optics.config.timing).footprint(turned)
    }

    pub(crate) fn draw(&self, frame: &mut RgbImage) -> LookupStats {
        let parity = FieldParity::of_field(self.number).first_line();
        let lines = (parity..self.optics.scan.height()).step_by(2);
        let runs: Vec<Run> = lines.flat_map(|y| self.runs(y)).collect();
        // Compute only the regions that some pixel reads.
        let wanted = self.wanted(&runs);
        let faces: Vec<FaceSet> = self.shown.memories.iter().map(|memory| drawn(memory, &wanted)).collect();
        let mut memories: Vec<&FaceSet> = faces.iter().collect();
        let background = if self.optics.config.has_background_memory { memories.pop() } else { None };
        let mut lookup = Lookup::new(&self.optics.config, self.optics.table(), memories, background);
        let mut stats = LookupStats::default();
        let mut colours = vec![0; self.optics.scan.width() as usize];
        // Compute the pixels of each run with its own orientation.
        for run in runs {
            let pixels = &mut colours[..run.count as usize];
            stats.add(lookup.run(self.place(&run), &run.matrix, pixels));
            write(frame, &run, pixels);
        }
        stats
    }

    fn place(&self, run: &Run) -> usize {
        run.y as usize * self.optics.scan.width() as usize + run.x as usize
    }

    /// Returns a flag for each region of the faces: true if a pixel of the field reads the region.
    fn wanted(&self, runs: &[Run]) -> Vec<bool> {
        let grid = region_grid(self.optics.config.timing.face_texels as u32);
        let mut wanted = vec![false; grid.regions() as usize];
        let addressing = Addressing::new(&self.optics.config, self.optics.table());
        for run in runs {
            addressing.mark(self.place(run), run.count as usize, &run.matrix, &mut wanted);
        }
        wanted
    }

    fn runs(&self, y: u32) -> Vec<Run> {
        let width = self.optics.scan.width();
        let whole = self.matrix(0, y).map(|matrix| Run { x: 0, y, count: width, matrix });
        let is_one = self.optics.config.latch != Latch::Pixel || self.matrix(width - 1, y) == self.matrix(0, y);
        if is_one {
            return whole.into_iter().collect();
        }
        // With a latch per pixel, start a new run when the matrix changes.
        let mut runs: Vec<Run> = Vec::new();
        for x in 0..width {
            let Some(matrix) = self.matrix(x, y) else { continue };
            match runs.last_mut().filter(|run| run.matrix == matrix) {
                Some(run) => run.count += 1,
                None => runs.push(Run { x, y, count: 1, matrix }),
            }
        }
        runs
    }
}

fn drawn((kind, regions): &(MemoryKind, Arc<Regions>), wanted: &[bool]) -> FaceSet {
    let mut faces = FaceSet::new(kind.face_texels, kind.format);
    kind.draw(regions, wanted, &mut faces);
    faces
}

fn write(frame: &mut RgbImage, run: &Run, colours: &[u32]) {
    for (x, colour) in (run.x..).zip(colours) {
        let [_, red, green, blue] = colour.to_be_bytes();
        frame.put_pixel(x, run.y, Rgb([red, green, blue]));
    }
}
