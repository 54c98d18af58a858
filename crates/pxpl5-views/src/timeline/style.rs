//! Colours, patterns and labels.

use super::model::Bar;
use pxpl5_gp::Stage;
use pxpl5_wire::Eye;

/// A stage's colours: light, and dark enough for text and hatching on white.
pub(super) struct Colours {
    pub(super) light: &'static str,
    pub(super) dark: &'static str,
}

/// All stages that have bars, with their names.
pub(super) const STAGES: [(Stage, &str); 5] = [
    (Stage::Send, "SEND"),
    (Stage::Edit, "EDIT"),
    (Stage::Transform, "TRANSFORM"),
    (Stage::Render, "RENDER"),
    (Stage::Copy, "COPY"),
];

/// Hues that stay apart for the common kinds of colour blindness and, by lightness, in grey.
pub(super) const fn colours(stage: Stage) -> Colours {
    match stage {
        Stage::Send => Colours { light: "#d9d9d9", dark: "#4d4d4d" },
        Stage::Edit => Colours { light: "#f2d0e4", dark: "#8e2a6b" },
        Stage::Transform => Colours { light: "#bcdcf5", dark: "#0b5394" },
        Stage::Render => Colours { light: "#fbd9a5", dark: "#a35200" },
        Stage::Copy | Stage::Sample | Stage::Swap => Colours { light: "#c3e6c4", dark: "#1b6b2f" },
    }
}

pub(super) const fn name(stage: Stage) -> &'static str {
    match stage {
        Stage::Send => "send",
        Stage::Edit => "edit",
        Stage::Transform => "transform",
        Stage::Render => "render",
        Stage::Copy => "copy",
        Stage::Sample => "sample",
        Stage::Swap => "swap",
    }
}

/// The pattern's suffix: right eyes are hatched.
pub(super) const fn pattern(eye: Option<Eye>) -> &'static str {
    match eye {
        Some(Eye::Right) => "right",
        Some(Eye::Left) | None => "plain",
    }
}

/// Letters as in the papers: E, TL, TR, RL, RR, CL, CR; a `t` or `b` for a half that is copied apart.
pub(super) fn letters(bar: &Bar) -> String {
    let stage = match bar.stage {
        Stage::Send => "S",
        Stage::Edit => "E",
        Stage::Transform => "T",
        Stage::Render => "R",
        Stage::Copy => "C",
        Stage::Sample | Stage::Swap => "",
    };
    let eye = match bar.eye {
        Some(Eye::Left) => "L",
        Some(Eye::Right) => "R",
        None => "",
    };
    let half = match bar.bottom {
        Some(false) => "t",
        Some(true) => "b",
        None => "",
    };
    format!("{stage}{eye}{half}")
}
