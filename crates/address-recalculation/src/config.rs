//! What a display is built of.

use crate::address::{AddressUnit, Footprint};
use crate::composition::{Composition, CompositionOrder};
use crate::error::ArpError;
use crate::face::FaceGeometry;
use crate::lens::{Lens, LensTable, Picture, unit_words};
use crate::orientation::Orientation;
use crate::scan::{Latch, Scan};
use crate::texel::TexelFormat;
use crate::timing::{ArpTiming, ScanTiming};
use parameters::check;

/// Numbers, lens and choices of an address recalculation pipeline.
#[derive(Clone, Debug, PartialEq)]
pub struct ArpConfig {
    /// Words, memories and clock.
    pub timing: ArpTiming,
    /// The scan of its picture.
    pub scan: ScanTiming,
    /// What lies between picture and eye.
    pub lens: Lens,
    /// Before what the orientation is latched.
    pub latch: Latch,
    /// Whether depths or weights come first.
    pub order: CompositionOrder,
    /// What empty texels show: 0x00RRGGBB.
    pub background: u32,
    /// Whether there is a memory without depth behind all others, with a port of its own, for what never changes.
    pub has_background_memory: bool,
    /// Fields that are remembered, 1 to 1,000; an interlaced picture takes two.
    pub fields_kept: u64,
}

impl ArpConfig {
    /// Fed by Pixel-Planes 5: faces of 256 texels, which a port of the ring can fill 25 times a second.
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

    /// Fed by an ideal renderer: faces of 512 texels.
    pub const IDEAL: Self = Self { timing: ArpTiming { face_texels: 512, ..ArpTiming::PAPERS }, ..Self::MACHINE };

    /// Checks that a display can be built: numbers, rules between them, and the lens.
    ///
    /// # Errors
    ///
    /// [`ArpError`] names the key, what was expected and what was found.
    pub fn check(&self) -> Result<(), ArpError> {
        self.timing.check()?;
        self.scan.check()?;
        check("fields_kept", self.fields_kept, (1, 1_000)).map_err(|error| ArpError::Number(format!("arp.{error}")))?;
        self.lens.check(&self.picture())
    }

    /// Size and angle of the picture.
    #[must_use]
    pub fn picture(&self) -> Picture {
        let height = self.scan.visible_lines as u32 * 2;
        Picture { width: self.scan.visible_pixels as u32, height, horizontal_deg: self.timing.horizontal_deg }
    }

    /// The table of viewing vectors.
    ///
    /// # Errors
    ///
    /// As [`ArpConfig::check`].
    pub fn table(&self) -> Result<LensTable, ArpError> {
        self.check()?;
        LensTable::new(&self.lens, &self.picture(), self.timing.vector_bits)
    }

    /// Which texels of the faces a pixel is for an orientation of the head, and their weights, as the hardware's words have it; `None`
    /// beyond the picture.
    ///
    /// # Errors
    ///
    /// As [`ArpConfig::check`].
    pub fn footprint(&self, x: u32, y: u32, orientation: &Orientation) -> Result<Option<Footprint>, ArpError> {
        self.check()?;
        let picture = self.picture();
        if x >= picture.width || y >= picture.height {
            return Ok(None);
        }
        let vector = unit_words(self.lens.view(&picture, x, y), self.timing.vector_bits);
        let turned = orientation.words(self.timing.matrix_bits).turn(vector);
        Ok(AddressUnit::new(&self.timing).footprint(turned))
    }

    /// When pixels light and latch.
    ///
    /// # Errors
    ///
    /// As [`ArpConfig::check`].
    pub fn scan(&self) -> Result<Scan, ArpError> {
        Scan::new(self.scan, &self.timing)
    }

    /// Size of the faces.
    #[must_use]
    pub const fn geometry(&self) -> FaceGeometry {
        FaceGeometry { texels: self.timing.face_texels as u32, guard: self.timing.guard_texels as u32 }
    }

    /// What a display memory keeps of a texel.
    #[must_use]
    pub const fn format(&self) -> TexelFormat {
        TexelFormat::new(&self.timing)
    }

    /// How memories become pixels.
    #[must_use]
    pub const fn composition(&self) -> Composition {
        Composition {
            order: self.order,
            background: self.background & 0x00FF_FFFF,
            weight_bits: self.timing.weight_bits,
        }
    }

    /// Ports of one eye: one for each memory, and one for the background memory.
    #[must_use]
    pub const fn ports_of_an_eye(&self) -> usize {
        self.timing.display_memories as usize + self.has_background_memory as usize
    }
}
