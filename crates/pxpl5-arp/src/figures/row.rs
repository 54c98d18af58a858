//! A row: what is printed, what comes out, and how it came to be.

use serde::Serialize;

/// How a row came to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Standing {
    /// Simulated, with nothing fitted to it.
    Checked,
    /// Simulated with a number that was chosen so that this row agrees.
    Fitted,
    /// It depends on what is not printed: the interval of all interpretations is compared.
    Interpretation,
    /// Its conditions are not printed: the number cannot be reproduced, its shape is checked.
    Shape,
}

impl Standing {
    /// As the document says it.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Checked => "checked",
            Self::Fitted => "fitted",
            Self::Interpretation => "depends on the interpretation",
            Self::Shape => "cannot be reproduced, shape checked",
        }
    }
}

/// A published or derived number beside ours.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The experiment that it belongs to, E1 to E9.
    pub experiment: &'static str,
    /// Its name in the specification.
    pub id: &'static str,
    /// What it is.
    pub statement: String,
    /// Unit of both numbers.
    pub unit: &'static str,
    /// As printed, or as derived from what is printed; not a number (null in JSON) where a drawing shows a shape without numbers.
    pub published: f64,
    /// Ours.
    pub ours: f64,
    /// How it came to be.
    pub standing: Standing,
    /// Whether ours agrees: within 1 percent; of what cannot be reproduced, whether its shape is as printed.
    pub is_met: bool,
}

impl Row {
    /// Of numbers that should be the same to a percent.
    #[must_use]
    pub fn number(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], standing: Standing) -> Self {
        let [published, ours] = both;
        let is_met = (ours - published).abs() <= 0.01 * published.abs();
        Self { experiment: "", id, statement: statement.to_owned(), unit, published, ours, standing, is_met }
    }

    /// Of a number that cannot be reproduced, with what holds of its shape.
    #[must_use]
    pub fn shape(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], holds: bool) -> Self {
        Self { is_met: holds, ..Self::number(id, statement, unit, both, Standing::Shape) }
    }

    /// Of a number with a limit of its own kind, such as "less than".
    #[must_use]
    pub fn limit(id: &'static str, statement: &str, unit: &'static str, both: [f64; 2], is_met: bool) -> Self {
        Self { is_met, ..Self::number(id, statement, unit, both, Standing::Checked) }
    }

    /// The same as a row of an experiment.
    #[must_use]
    pub fn of(self, experiment: &'static str) -> Self {
        Self { experiment, ..self }
    }

    /// Ours against the published, percent; none of a published 0 and where no number is published.
    #[must_use]
    pub fn error_percent(&self) -> Option<f64> {
        self.published.is_normal().then(|| 100.0 * (self.ours / self.published - 1.0))
    }

    /// What came of it: met, within (the interval of all interpretations), shape (what cannot be reproduced has the printed shape) or
    /// missed.
    #[must_use]
    pub const fn verdict(&self) -> &'static str {
        match (self.is_met, self.standing) {
            (false, _) => "missed",
            (true, Standing::Shape) => "shape",
            (true, Standing::Interpretation) => "within",
            (true, _) => "met",
        }
    }

    /// What is known of why it is missed.
    #[must_use]
    pub fn cause(&self) -> &'static str {
        match self.id {
            "A8" => "No interpretation of size and distance gives so much.",
            "A12" => {
                "Scene, path, rings and threshold are not printed; the one number that is fitted is that of memory 1."
            }
            _ => "The cause is not known.",
        }
    }
}
