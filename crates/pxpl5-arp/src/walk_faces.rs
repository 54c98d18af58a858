//! The view that the eye sees: cube faces are drawn from the memories' contents and then sampled by the display.

use crate::cube_faces::DrawCounts;
use crate::simulation::Simulation;
use address_recalculation::{ArpConfig, FaceSet, LensTable, Lookup, LookupStats, Orientation};
use glam::DQuat;
use image::{Rgb, RgbImage};
use pxpl5_sim::parameters::SettingError;

/// Cube faces of all memories, drawn only when a view needs them.
#[derive(Clone, Debug)]
pub struct WalkFaces {
    /// Cube faces of each display memory. The faces are empty before the memory's first update.
    pub memories: Vec<FaceSet>,
    /// Counts of the triangles drawn into the faces.
    pub drawing: DrawCounts,
    config: ArpConfig,
    /// Background colour, 0x00RRGGBB.
    pub background: u32,
}

impl WalkFaces {
    /// Draws the current contents of all memories.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`crate::WalkSettings::view`].
    pub fn of(simulation: &Simulation<'_>) -> Result<Self, SettingError> {
        let settings = &simulation.settings;
        let view = settings.view()?;
        let mut drawing = DrawCounts::default();
        let mut memories = Vec::new();
        // Memories without an update stay empty.
        for content in &simulation.shown {
            let mut faces = FaceSet::new(view.geometry.texels, settings.display.format());
            if let Some(content) = content {
                drawing.add(content.draw(simulation.world, &view, &mut faces));
            }
            memories.push(faces);
        }
        let background = simulation.world.background;
        Ok(Self { memories, drawing, config: ArpConfig { background, ..settings.display.clone() }, background })
    }

    /// Returns the same faces viewed through the lens `lens`.
    #[must_use]
    pub fn through(mut self, lens: address_recalculation::Lens) -> Self {
        self.config.lens = lens;
        self
    }

    /// Returns the picture that the eye sees. One head orientation applies to the whole picture.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the lens or the orientation is invalid.
    pub fn seen(&self, orientation: DQuat) -> Result<(RgbImage, LookupStats), SettingError> {
        let table = self.config.table()?;
        let words = Orientation::from_quaternion(orientation.to_array())?.words(self.config.timing.matrix_bits);
        let mut pixels = vec![0; (table.width() * table.height()) as usize];
        let stats = self.lookup(&table).run(0, &words, &mut pixels);
        Ok((picture(table.width(), &pixels, |colour| *colour), stats))
    }

    /// Returns the picture's width and, for each pixel row by row, the index of the memory whose colour is shown. A
    /// pixel at which all memories are empty has `None`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`WalkFaces::seen`].
    pub fn winners(&self, orientation: DQuat) -> Result<(u32, Vec<Option<u8>>), SettingError> {
        let table = self.config.table()?;
        let words = Orientation::from_quaternion(orientation.to_array())?.words(self.config.timing.matrix_bits);
        let mut winners = vec![None; (table.width() * table.height()) as usize];
        self.lookup(&table).winners(0, &words, &mut winners);
        Ok((table.width(), winners))
    }

    fn lookup<'a>(&'a self, table: &'a LensTable) -> Lookup<'a> {
        Lookup::new(&self.config, table, self.memories.iter().collect(), None)
    }
}

/// Returns a picture that is `width` pixels wide. `pixels` has one value for each pixel in row order. `colour` converts
/// each value to a colour.
pub(crate) fn picture<T>(width: u32, pixels: &[T], colour: impl Fn(&T) -> u32) -> RgbImage {
    let height = pixels.len() as u32 / width;
    RgbImage::from_fn(width, height, |x, y| rgb(colour(&pixels[(y * width + x) as usize])))
}

/// Converts a colour from the number 0x00RRGGBB.
pub(crate) fn rgb(colour: u32) -> Rgb<u8> {
    let [_, red, green, blue] = colour.to_be_bytes();
    Rgb([red, green, blue])
}
