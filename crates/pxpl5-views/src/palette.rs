//! Colours of the stages, the same in every drawing: one hue for each stage, in three tints.
//!
//! The fills of the stages can be distinguished with common kinds of colour blindness. The live page repeats them in its
//! style sheet, which a test compares.

use pxpl5_gp::Stage;

/// Tints of one stage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tints {
    /// Ground of a bar with text.
    pub ground: &'static str,
    /// Fill of a bar without text.
    pub fill: &'static str,
    /// Text and hatching on white.
    pub ink: &'static str,
}

const fn tints(ground: &'static str, fill: &'static str, ink: &'static str) -> Tints {
    Tints { ground, fill, ink }
}

/// Tints of each stage and of the scan, by the names that parts of latency and classes of style sheets have.
pub const STAGE_TINTS: [(&str, Tints); 6] = [
    ("send", tints("#d9d9d9", "#8f8f8f", "#4d4d4d")),
    ("edit", tints("#f2d0e4", "#c46aa5", "#8e2a6b")),
    ("transform", tints("#bcdcf5", "#4a90d0", "#0b5394")),
    ("render", tints("#fbd9a5", "#e8973a", "#a35200")),
    ("copy", tints("#c3e6c4", "#3d9a52", "#1b6b2f")),
    ("scan", tints("#fff3b0", "#c9b400", "#6b5f00")),
];

/// Tints of waiting times and of everything without a colour of its own.
pub const WAITING: Tints = tints("#eeeeee", "#d8d8d8", "#777777");

/// Returns the tints of a stage or of a part of the latency, such as `last_transform`.
pub fn tints_of(name: &str) -> Tints {
    let name = name.trim_start_matches("last_");
    STAGE_TINTS.iter().find(|(stage, _)| *stage == name).map_or(WAITING, |(_, tints)| *tints)
}

/// Returns the name of a stage in style sheets.
pub const fn class_of(stage: Stage) -> &'static str {
    Stage::ALL[stage as usize].0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a colour in linear red, green and blue, 0 to 1 (IEC 61966-2-1).
    fn linear(colour: &str) -> [f64; 3] {
        [1, 3, 5].map(|at| {
            let byte = u8::from_str_radix(&colour[at..at + 2], 16).expect("hexadecimal");
            let value = f64::from(byte) / 255.0;
            if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        })
    }

    /// Matrices of normal vision, protanopia and deuteranopia (Machado, Oliveira and Fernandes 2009, severity 1).
    const VISIONS: [[[f64; 3]; 3]; 3] = [
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[0.152_286, 1.052_583, -0.204_868], [0.114_503, 0.786_281, 0.099_216], [-0.003_882, -0.048_116, 1.051_998]],
        [[0.367_322, 0.860_646, -0.227_968], [0.280_085, 0.672_501, 0.047_413], [-0.011_820, 0.042_940, 0.968_881]],
    ];

    /// Returns a colour in CIE L*a*b* with the white of sRGB.
    fn lab(rgb: [f64; 3]) -> [f64; 3] {
        let [r, g, b] = rgb.map(|value| value.clamp(0.0, 1.0));
        let xyz = [
            (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505,
            0.2126 * r + 0.7152 * g + 0.0722 * b,
            (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089,
        ];
        let [x, y, z] = xyz.map(|t| if t > 0.008_856 { t.cbrt() } else { 7.787 * t + 16.0 / 116.0 });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn fills_of_stages_can_be_distinguished_with_common_kinds_of_colour_blindness() {
        for vision in VISIONS {
            let seen = |colour: &str| {
                let rgb = linear(colour);
                lab(vision.map(|row| row.iter().zip(rgb).map(|(factor, value)| factor * value).sum()))
            };
            for (i, (one, tints)) in STAGE_TINTS.iter().enumerate() {
                for (other, others) in &STAGE_TINTS[..i] {
                    let pair = seen(tints.fill).into_iter().zip(seen(others.fill));
                    let distance = pair.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
                    // A difference of 2.3 is just noticeable (Mahy and others 1994).
                    assert!(distance > 4.0 * 2.3, "{one} and {other}: {distance:.1}");
                }
            }
        }
    }

    #[test]
    fn the_style_sheet_of_the_live_page_has_the_same_colours() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../pxpl5-web/page/style.css");
        // A package on its own has no live page.
        let Ok(style) = std::fs::read_to_string(path) else { return };
        for (stage, tints) in STAGE_TINTS {
            assert!(style.contains(&format!("--{stage}: {};", tints.fill)), "--{stage}: {};", tints.fill);
        }
    }
}
