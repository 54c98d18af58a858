//! A straight edge seen through a lens, to test the lens correction.

use crate::cube_faces::{Corner, CubeView, DepthRange};
use address_recalculation::{ArpConfig, FaceSet, Lens, Lookup, Orientation};
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;

/// Returns the bend of an upright edge, on the screen and as seen through the lens. The unit is the size of a pixel in
/// the middle of the picture.
///
/// The edge lies 20 degrees to the right. The bend is the largest distance of the edge from the straight line between
/// its ends.
///
/// # Errors
///
/// Returns a [`SettingError`] if the lens is invalid.
pub fn straight_edge(lens: Lens) -> Result<[f64; 2], SettingError> {
    let config = ArpConfig { lens, ..ArpConfig::IDEAL };
    let config =
        ArpConfig { timing: address_recalculation::ArpTiming { display_memories: 1, ..config.timing }, ..config };
    let view = CubeView { geometry: config.geometry(), depth: DepthRange::new(0.1, 100.0)? };
    // Draw the edge of a large bright square.
    let tangent = libm::tan(20_f64.to_radians());
    let corner = |x: f64, y: f64| Corner { place: DVec3::new(x, y, -1.0) * 9.0, colour: 0x00FF_FFFF };
    let edge = [
        [corner(tangent, -9.0), corner(9.0, -9.0), corner(9.0, 9.0)],
        [corner(tangent, -9.0), corner(9.0, 9.0), corner(tangent, 9.0)],
    ];
    let mut faces = FaceSet::new(config.timing.face_texels as u32, config.format());
    view.draw(DVec3::ZERO, edge, &mut faces);
    let table = config.table()?;
    let picture = config.picture();
    let mut lookup = Lookup::new(&config, &table, vec![&faces], None);
    let mut points = [Vec::new(), Vec::new()];
    let focal = f64::from(picture.width) / 2.0 / libm::tan(picture.horizontal_deg.to_radians() / 2.0);
    // Find the edge in each row of the picture.
    for y in 0..picture.height {
        let mut row = vec![0; picture.width as usize];
        let words = Orientation::IDENTITY.words(config.timing.matrix_bits);
        lookup.run((y * picture.width) as usize, &words, &mut row);
        let Some(x) = row.iter().position(|colour| colour & 0xFF > 0x7F).filter(|x| *x > 0) else { continue };
        // Interpolate the position at which the edge has half brightness.
        let [dark, bright] = [x - 1, x].map(|x| f64::from(row[x] & 0xFF));
        let share = (127.5 - dark) / (bright - dark);
        points[0].push([x as f64 - 1.0 + share, f64::from(y)]);
        let [left, right] = [x - 1, x].map(|x| DVec3::from_array(config.lens.view(&picture, x as u32, y)));
        let seen = left.lerp(right, share);
        points[1].push([seen.x / -seen.z * focal, seen.y / seen.z * focal]);
    }
    Ok(points.map(|points| bend(&points)))
}

/// Returns the largest distance of the points from the straight line between the first and the last point.
fn bend(points: &[[f64; 2]]) -> f64 {
    let [Some(first), Some(last)] = [points.first(), points.last()] else { return f64::NAN };
    let along = [last[0] - first[0], last[1] - first[1]];
    let length = libm::hypot(along[0], along[1]);
    let off = |point: &[f64; 2]| ((point[0] - first[0]) * along[1] - (point[1] - first[1]) * along[0]).abs() / length;
    points.iter().map(off).fold(0.0, f64::max)
}
