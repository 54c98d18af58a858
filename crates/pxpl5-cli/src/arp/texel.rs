//! The command `pxpl5 arp texel`, which prints the texels of the cube faces that one pixel shows.

use super::settings::WalkArgs;
use crate::error::CliError;
use crate::terminal::print;
use clap::Args;
use pxpl5::arp::address_recalculation::{ArpConfig, Footprint, Orientation, TexelAddress};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Print the cube face and the texels that a pixel shows at an orientation of the head.
#[derive(Args, Debug)]
#[command(after_help = "Examples:
  pxpl5 arp texel 0 0 --yaw 30
  pxpl5 arp texel 320 240 --pitch 60 --lens radial:0.32 --set arp.face_texels=256 --json

Angles are in degrees. The rotations are yaw to the left about the upright axis, then pitch up, then roll to the left.")]
pub(super) struct TexelArgs {
    /// Column of the pixel from the left.
    x: u32,
    /// Line of the pixel from the top, counted in the whole frame.
    y: u32,
    /// Rotation of the head to the left, in degrees.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true)]
    yaw: f64,
    /// Rotation of the head upward, in degrees.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true)]
    pitch: f64,
    /// Tilt of the head to the left, in degrees.
    #[arg(long, value_name = "DEG", default_value_t = 0.0, allow_negative_numbers = true)]
    roll: f64,
    /// Lens before the eye: flat, radial:K1, radial:K1:K2, or equidistant; default flat.
    #[arg(long, value_name = "LENS", allow_hyphen_values = true)]
    lens: Option<String>,
    /// Set a number of the display by its path, such as arp.face_texels=256; may be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    sets: Vec<String>,
    /// Print one JSON object.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: TexelArgs) -> Result<(), CliError> {
    let display = WalkArgs::of_display(args.lens.as_ref(), &args.sets)?;
    let orientation = Orientation::from_quaternion(quaternion([args.yaw, args.pitch, args.roll]));
    let found = orientation.and_then(|orientation| display.footprint(args.x, args.y, &orientation));
    let Some(footprint) = found? else {
        let picture = display.picture();
        let [width, height] = [picture.width, picture.height];
        let found = format!("pixel {} {}", args.x, args.y);
        return Err(CliError::usage(format!("expected a pixel of {width} x {height}, found {found}")));
    };
    if args.json {
        return print(&format!("{:#}\n", record(&args, &display, &footprint)));
    }
    print(&text(&args, &display, &footprint))
}

/// Returns the quaternion (x, y, z, w) of a rotation: yaw about y, then pitch about x, then roll about z.
fn quaternion(degrees: [f64; 3]) -> [f64; 4] {
    let [(sy, cy), (sp, cp), (sr, cr)] = degrees.map(|angle| (angle.to_radians() / 2.0).sin_cos());
    [cy * sp * cr + sy * cp * sr, sy * cp * cr - cy * sp * sr, cy * cp * sr - sy * sp * cr, cy * cp * cr + sy * sp * sr]
}

/// Returns the four texels that a pixel shows, with weights that sum to 1. At a corner of the cube, the fourth texel is
/// `None`. Its weight then applies to the mean of the other three texels.
fn texels(display: &ArpConfig, footprint: &Footprint) -> [(Option<TexelAddress>, f64); 4] {
    let weights = footprint.weights(display.timing.weight_bits);
    let one = f64::from(1_u32 << (2 * display.timing.weight_bits));
    [0, 1, 2, 3].map(|i| (footprint.texels[i], f64::from(weights[i]) / one))
}

fn record(args: &TexelArgs, display: &ArpConfig, footprint: &Footprint) -> Value {
    // A missing texel beyond a cube corner has a weight but no address.
    let texels = texels(display, footprint).map(|(texel, weight)| match texel {
        Some(texel) => json!({
            "face": format!("{:?}", texel.face),
            "column": texel.column,
            "row": texel.row,
            "bank": texel.bank(),
            "word": texel.word(display.timing.face_texels as u32),
            "weight": weight,
        }),
        None => json!({ "face": null, "weight": weight }),
    });
    json!({
        "schema": "pxpl5-arp-texel/1",
        "pixel": [args.x, args.y],
        "yaw_pitch_roll_deg": [args.yaw, args.pitch, args.roll],
        "face_texels": display.timing.face_texels,
        "texels": texels,
        "is_split": footprint.is_split,
    })
}

fn text(args: &TexelArgs, display: &ArpConfig, footprint: &Footprint) -> String {
    let mut text = format!(
        "pixel {}, {}\n{:<6} {:>6} {:>6} {:>5} {:>8}\n",
        args.x, args.y, "face", "column", "row", "bank", "weight"
    );
    for (texel, weight) in texels(display, footprint) {
        let _ = match texel {
            Some(texel) => {
                let face = format!("{:?}", texel.face);
                writeln!(text, "{face:<6} {:>6} {:>6} {:>5} {weight:>8.4}", texel.column, texel.row, texel.bank())
            }
            None => writeln!(text, "{:<6} {:>6} {:>6} {:>5} {weight:>8.4}", "mean", "-", "-", "-"),
        };
    }
    text
}
