//! Configuration of the address recalculation display.

use crate::address::{AddressUnit, Footprint};
use crate::composition::{Composition, CompositionOrder};
use crate::face::FaceGeometry;
use crate::lens::{Lens, LensPicture, LensTable, unit_words};
use crate::orientation::Orientation;
use crate::scan::{FaceScan, Latch};
use crate::texel::TexelFormat;
use crate::timing::{ArpTiming, ScanTiming};
use pxpl5_sim::parameters::{SettingError, check};

/// Parameters, lens and options of an address recalculation pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct ArpConfig {
    /// Word lengths, number of memories, and time per stage of the pipeline.
    pub timing: ArpTiming,
    pub scan: ScanTiming,
    pub lens: Lens,
    /// Times at which the display reads the orientation: once per field, per line or per pixel.
    pub latch: Latch,
    pub order: CompositionOrder,
    /// Colour of empty texels, 0x00RRGGBB.
    pub background: u32,
    /// True if there is a background memory: a memory without depth, with its own port.
    pub has_background_memory: bool,
    /// Number of past fields that the display keeps for reading, 1 to 1,000. An interlaced picture needs two.
    pub fields_kept: u64,
}

impl ArpConfig {
    /// Configuration for Pixel-Planes 5, with faces of 256 texels. A port of the ring can fill such faces 25 times per
    /// second.
    pub const MACHINE: Self = Self {
        timing: ArpTiming::PAPERS,
        scan: ScanTiming::PAPERS,
        lens: Lens::Flat,
        latch: Latch::Field,
        order: CompositionOrder::DepthFirst,
        background: 0,
        has_background_memory: false,
        fields_kept: 2,
    };

    /// Configuration for an ideal renderer: faces of 512 texels.
    pub const IDEAL: Self = Self { timing: ArpTiming { face_texels: 512, ..ArpTiming::PAPERS }, ..Self::MACHINE };

    /// Checks all parameters, the rules between them, and the lens.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the parameter, the expected and the found value.
    pub fn check(&self) -> Result<(), SettingError> {
        self.timing.check()?;
        self.scan.check()?;
        check("fields_kept", self.fields_kept, (1, 1_000)).map_err(|error| error.in_table("arp"))?;
        self.lens.check(&self.picture())
    }

    pub fn picture(&self) -> LensPicture {
        let height = self.scan.visible_lines as u32 * 2;
        LensPicture { width: self.scan.visible_pixels as u32, height, horizontal_deg: self.timing.horizontal_deg }
    }

    /// Returns the table of viewing vectors, one for each pixel.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`ArpConfig::check`].
    pub fn table(&self) -> Result<LensTable, SettingError> {
        self.check()?;
        LensTable::new(&self.lens, &self.picture(), self.timing.vector_bits)
    }

    /// Returns the texels and weights of a pixel for an orientation of the head, in the word lengths of the hardware.
    ///
    /// Returns `None` for a pixel outside the picture.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`ArpConfig::check`].
    pub fn footprint(&self, x: u32, y: u32, orientation: &Orientation) -> Result<Option<Footprint>, SettingError> {
        self.check()?;
        let picture = self.picture();
        if x >= picture.width || y >= picture.height {
            return Ok(None);
        }
        let vector = unit_words(self.lens.view(&picture, x, y), self.timing.vector_bits);
        let turned = orientation.words(self.timing.matrix_bits).turn(vector);
        Ok(AddressUnit::new(&self.timing).footprint(turned))
    }

    /// Returns the scan, which computes when each pixel is displayed and when its orientation is read.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`ArpConfig::check`].
    pub fn scan(&self) -> Result<FaceScan, SettingError> {
        FaceScan::new(self.scan, &self.timing)
    }

    pub const fn geometry(&self) -> FaceGeometry {
        FaceGeometry { texels: self.timing.face_texels as u32, guard: self.timing.guard_texels as u32 }
    }

    pub const fn format(&self) -> TexelFormat {
        TexelFormat::new(&self.timing)
    }

    pub const fn composition(&self) -> Composition {
        Composition {
            order: self.order,
            background: self.background & 0x00FF_FFFF,
            weight_bits: self.timing.weight_bits,
        }
    }

    /// Returns the number of ports per eye: one per memory, plus one for the background memory.
    pub const fn ports_of_an_eye(&self) -> usize {
        self.timing.display_memories as usize + self.has_background_memory as usize
    }
}
