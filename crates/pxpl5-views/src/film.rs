//! Films: what a viewer sees, period by period, as animated PNG.

/// Which eyes a film shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Eyes {
    /// One.
    One(Eye),
    /// Left and right side by side; a mono pipeline has a left eye only.
    Both,
}

/// A film: a frame each field, in which the lines of the field before stand between its own.
#[derive(Clone, Debug)]
pub struct Film {
    experiment: Experiment,
    first_field: u64,
    fields: u64,
    eyes: Eyes,
}

/// Why a film could not be made.
#[derive(Debug)]
#[non_exhaustive]
pub enum FilmError {
    /// The experiment cannot be run.
    Experiment(ExperimentError),
    /// The machine stopped.
    Run(crate::machine::RunError),
    /// A film of no field, or of more than a PNG can hold.
    Fields {
        /// Smallest and largest number.
        expected: (u64, u64),
        /// What was asked for.
        found: u64,
    },
    /// The PNG could not be written.
    Png(png::EncodingError),
}

impl fmt::Display for FilmError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Experiment(error) => error.fmt(f),
            Self::Run(error) => error.fmt(f),
            Self::Fields { expected: (low, high), found } => {
                write!(f, "a film has {low} to {high} fields, found {found}")
            }
            Self::Png(error) => write!(f, "the film cannot be written: {error}"),
        }
    }
}

impl std::error::Error for FilmError {}

impl From<png::EncodingError> for FilmError {
    fn from(error: png::EncodingError) -> Self {
        Self::Png(error)
    }
}

/// Smallest and largest number of fields in a film: an hour and more.
pub const FILM_FIELDS: (u64, u64) = (1, 250_000);

/// The time of a frame of a film as a fraction of seconds: an NTSC field.
pub const FRAME_SECONDS: (u16, u16) = (1_001, 60_000);

impl Film {
    /// A film of an experiment, from a field on.
    #[must_use]
    pub const fn new(experiment: Experiment, first_field: u64, fields: u64, eyes: Eyes) -> Self {
        Self { experiment, first_field, fields, eyes }
    }

    /// Runs the experiment and writes the film as animated PNG. `texts` go into the file's text chunks.
    ///
    /// # Errors
    ///
    /// [`FilmError`]; the file is then not complete.
    pub fn write(&self, texts: &[(&str, String)], out: impl Write) -> Result<(), FilmError> {
        if !(FILM_FIELDS.0..=FILM_FIELDS.1).contains(&self.fields) {
            return Err(FilmError::Fields { expected: FILM_FIELDS, found: self.fields });
        }
        let offsets = self.offsets()?;
        let mut machine = self.experiment.build().map_err(FilmError::Experiment)?;
        let mut encoder = self.encoder(&machine, texts, out)?;
        for field in self.first_field..self.first_field + self.fields {
            // A field has been scanned when the next one has begun, all of whose events are taken.
            let begun = machine.video().retrace(field + 1) + pxpl5_sim::Span(1);
            machine.run_until(begun).map_err(FilmError::Run)?;
            encoder.write_image_data(self.frame(&machine, field, offsets.as_ref()).as_raw())?;
        }
        Ok(encoder.finish()?)
    }

    /// How a display shifts each field, known from a run without pixels.
    fn offsets(&self) -> Result<Option<RasterOffsets>, FilmError> {
        if self.experiment.display() == Display::Plain {
            return Ok(None);
        }
        let last = self.first_field + self.fields;
        let outcome = self.experiment.clone().pixels(Pixels::Off).fields(last + 1).run();
        Ok(RasterOffsets::of(&outcome.map_err(FilmError::Experiment)?))
    }

    fn encoder<W: Write>(
        &self,
        machine: &Machine,
        texts: &[(&str, String)],
        out: W,
    ) -> Result<png::Writer<W>, FilmError> {
        let (width, height) = (machine.video().width(), machine.video().height());
        let mut encoder = png::Encoder::new(out, width * self.eyes().len() as u32, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(self.fields as u32, 0)?;
        encoder.set_frame_delay(FRAME_SECONDS.0, FRAME_SECONDS.1)?;
        for (key, value) in texts {
            encoder.add_itxt_chunk(format!("pxpl5 {key}"), value.clone())?;
        }
        Ok(encoder.write_header()?)
    }

    fn eyes(&self) -> &[Eye] {
        match &self.eyes {
            Eyes::One(eye) => std::slice::from_ref(eye),
            Eyes::Both => &Eye::BOTH,
        }
    }

    fn frame(&self, machine: &Machine, field: u64, offsets: Option<&RasterOffsets>) -> RgbImage {
        let eyes: Vec<RgbImage> = self.eyes().iter().map(|eye| screen(machine, *eye, field, offsets)).collect();
        match &eyes[..] {
            [left, right] => side_by_side(left, right),
            _ => eyes.into_iter().next().unwrap_or_default(),
        }
    }
}

