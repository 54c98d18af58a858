//! Statements of the SpatialGL paper that contain no numbers. The model confirms or refutes each statement by
//! measurements.

use super::plain::plain;
use crate::choices::{ClipKind, ProjectionKind};
use crate::experiment::Volume;
use crate::settings::VolumeSettings;
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::SettingError;
use serde::Serialize;
use spatialgl::{
    CommandBuffer, DrawContext, HalfWedge, SliceClip, SliceVolume, TieRule, Topology, VertexBuffer, VolumeStats,
    WedgePlanes, WedgeTest, Workers, gap_correlation, tessellated_sphere,
};
use std::sync::Arc;

/// A statement of the SpatialGL paper without numbers, and the measurements that test it.
#[derive(Clone, Debug, Serialize)]
pub struct ShownStatement {
    /// Statement of the SpatialGL paper, in words.
    pub statement: &'static str,
    /// Measured numbers that confirm or refute the statement.
    pub evidence: String,
    /// True if the numbers confirm the statement.
    pub holds: bool,
}

/// Tests all statements of the SpatialGL paper that have no numbers. If a statement needs a scene, the test uses the
/// first of `scenes`.
pub(super) fn all(scenes: &[Arc<Scene>], workers: &dyn Workers) -> Result<Vec<ShownStatement>, SettingError> {
    let mut shown = vec![dead_zone(), dilation()];
    if let Some(scene) = scenes.first() {
        let volume = Volume::draw(&plain(), scene, workers)?;
        shown.insert(0, prism(scene, workers)?);
        shown.push(limits(&volume));
        shown.push(tiles(scene, workers)?);
    }
    shown.push(orthographic(workers)?);
    shown.push(noise(workers)?);
    Ok(shown)
}

/// Compares the lit pixels with the prism clip and with the exact clip, in rings of 8 px around the axis.
fn prism(scene: &Scene, workers: &dyn Workers) -> Result<ShownStatement, SettingError> {
    let rings = |clip| {
        let volume = Volume::draw(&VolumeSettings { clip, ..plain() }, scene, workers)?;
        Ok::<_, SettingError>(volume.brightness().lit_voxels)
    };
    let prism = rings(ClipKind::Prism)?;
    let exact = rings(ClipKind::Exact)?;
    let ratio = |from: usize, to: usize| {
        let sum = |rings: &[u64]| rings[from..to].iter().sum::<u64>() as f64;
        sum(&prism) / sum(&exact).max(1.0)
    };
    // Rings 1 to 3 are near the axis, rings 36 to 42 near the rim.
    let near = ratio(1, 4);
    let far = ratio(36, 43);
    Ok(ShownStatement {
        statement: "the bounding prism is blurry and too bright near the axis",
        evidence: format!(
            "{}: {near:.1} times as many lit pixels as the exact clip from 8 to 32 px from the axis, {far:.2} times from 288 to 344 px",
            scene.name()
        ),
        holds: near > 4.0 && far < 1.5,
    })
}

/// Measures the radius around the axis within which no point is accepted if planes have few fraction bits. The derived
/// radius is 2^-(bits + 1) / S, where S is the sine of half the angle between slices.
fn dead_zone() -> ShownStatement {
    let radius = |bits: u32| {
        let wedge = HalfWedge::new(396, 384.0);
        // Walk along u in the middle of a wedge until a point is accepted.
        let planes = WedgePlanes { a: [wedge.sin, wedge.cos], b: [wedge.sin, -wedge.cos], fraction_bits: Some(bits) };
        let volume = SliceVolume::Wedge(planes, WedgeTest::Shader(TieRule::HalfOpen));
        let steps = (1..=10_000).map(|i| f64::from(i) * 1e-3);
        steps.take_while(|r| !volume.contains([*r, 0.0, 0.0], *r, 0.0)).last().unwrap_or(0.0)
    };
    let four = radius(4);
    let eight = radius(8);
    ShownStatement {
        statement: "clip planes leave a dead zone at the axis",
        evidence: format!(
            "planes of 4 fraction bits accept nothing within {four:.2} px (formula 3.94), of 8 bits within {eight:.3} px (0.246)"
        ),
        holds: (four - 3.939).abs() < 2e-3 && (eight - 0.246).abs() < 2e-3,
    }
}

fn dilation() -> ShownStatement {
    let wedge = HalfWedge::new(396, 384.0);
    let more =
        |clip: SliceClip, u: f64| clip.half_thickness(wedge, u) - SliceClip::ShaderPlanes.half_thickness(wedge, u);
    // Compare the thickness at the axis and at the rim.
    let parallel = [0.0, 384.0].map(|u| more(SliceClip::Parallel(0.5), u));
    let hyperbola = [0.0, 384.0].map(|u| more(SliceClip::Hyperbolic(0.25), u));
    ShownStatement {
        statement: "parallel offsets dilate everywhere, the hyperbola mainly at the axis",
        evidence: format!(
            "half a slab is thicker by {:.3} and {:.3} px with parallel offsets, at the axis and at the rim, and by {:.3} and {:.3} px \
             with the hyperbola",
            parallel[0], parallel[1], hyperbola[0], hyperbola[1]
        ),
        holds: (parallel[0] - parallel[1]).abs() < 1e-3 && hyperbola[0] > 10.0 * hyperbola[1],
    }
}

/// A test triangle in a plane perpendicular to the axis. Its corners are in pixels.
const LEVEL: [[f64; 3]; 3] = [[-200.3, 10.2, -100.4], [250.6, 10.2, -150.3], [30.7, 10.2, 260.9]];

fn orthographic(workers: &dyn Workers) -> Result<ShownStatement, SettingError> {
    let fragments = |projection| {
        let vertices = LEVEL.map(|corner| spatialgl::ColouredVertex::new(corner.into(), [255; 3])).to_vec();
        let settings = VolumeSettings { projection, ..VolumeSettings::paper() };
        let volume = Volume::draw_commands(&settings, "a level triangle", recording(vertices, &[0, 1, 2])?, workers)?;
        Ok::<_, SettingError>(volume.frame.stats.fragments_accepted)
    };
    let along = fragments(ProjectionKind::Orthographic)?;
    let jittered = fragments(ProjectionKind::Jittered)?;
    Ok(ShownStatement {
        statement: "an orthographic projection loses every plane perpendicular to the axis",
        evidence: format!("a triangle of 87,200 px^2 in such a plane: {along} fragments, and {jittered} with jitter"),
        holds: along == 0 && jittered > 0,
    })
}

fn recording(vertices: Vec<spatialgl::ColouredVertex>, indices: &[u32]) -> Result<CommandBuffer, SettingError> {
    let buffer = VertexBuffer::new(vertices)?;
    let mut context = DrawContext::default();
    context.draw_indexed(&buffer, indices, Topology::Triangles)?;
    Ok(context.present())
}

/// Compares the gaps in a displayed sphere with and without jitter. The sphere has 198 x 396 facets and a radius of 300
/// px. Every slice intersects equal facets, so all slices have the same gaps in an orthographic projection.
fn noise(workers: &dyn Workers) -> Result<ShownStatement, SettingError> {
    let likeness = |projection| {
        // If the sphere has as many facets around it as there are slices, the gaps of all slices are equal.
        let (vertices, indices) = tessellated_sphere(glam::DVec3::ZERO, 300.0, 198, [255; 3]);
        let settings = VolumeSettings { projection, ..VolumeSettings::paper() };
        let volume = Volume::draw_commands(&settings, "sphere", recording(vertices, &indices)?, workers)?;
        Ok::<_, SettingError>(gap_correlation(&volume.display, &volume.commands, &volume.frame).unwrap_or(f64::NAN))
    };
    let along = likeness(ProjectionKind::Orthographic)?;
    let jittered = likeness(ProjectionKind::Jittered)?;
    Ok(ShownStatement {
        statement: "jitter turns moire into uncorrelated noise",
        evidence: format!(
            "gaps of neighbouring slices of a sphere of 198 x 396 facets (shown share of each row): correlation {along:.2} along the normal, {jittered:.2} \
             with jitter"
        ),
        holds: jittered.abs() < 0.5 * along,
    })
}

/// Compares the parts of the modelled GPU time, and the bus times with and without packing and tiles.
fn limits(volume: &Volume) -> ShownStatement {
    let stats = &volume.frame.stats;
    let model = volume.settings.time_model();
    let size = volume.frame.planes.size();
    let time = volume.time();
    let unpacked = model.unpacked(stats, size);
    // The time of a volume with draws alone is the time of the vertices. The remaining time is fill.
    let vertices_only = VolumeStats { draws: stats.draws, ..VolumeStats::default() };
    let vertices_ms = model.unpacked(&vertices_only, size).gpu_ms;
    let fill_ms = unpacked.gpu_ms - vertices_ms;
    ShownStatement {
        statement: "rendering is limited by fill, and reading back is the narrow path",
        evidence: format!(
            "{}, model: fill {fill_ms:.1} ms against {vertices_ms:.1} ms for vertices; reading back {:.0} ms unpacked, {:.0} ms packed by \
             tiles, of a volume of {:.0} ms",
            volume.scene,
            unpacked.readback_ms,
            time.readback_ms,
            1e3 / time.serial_hz()
        ),
        holds: fill_ms > vertices_ms && unpacked.readback_ms > unpacked.gpu_ms,
    }
}

fn tiles(scene: &Scene, workers: &dyn Workers) -> Result<ShownStatement, SettingError> {
    let mut found = Vec::new();
    for size in [64, 32, 16, 8] {
        let mut settings = plain();
        settings.tile.size = size;
        let volume = Volume::draw(&settings, scene, workers)?;
        let stats = &volume.frame.stats;
        // Smaller tiles pack fewer pixels but need more queries.
        let queries_ms = (stats.queries * settings.gpu.query_ns) as f64 / 1e6;
        let share = 100.0 * stats.pixels_packed as f64 / (stats.bytes_unpacked / 4) as f64;
        found.push((size, share, queries_ms));
    }
    let text: Vec<String> = found
        .iter()
        .map(|(size, share, ms)| format!("{size} px: {share:.1} % packed, {ms:.0} ms of queries"))
        .collect();
    Ok(ShownStatement {
        statement: "smaller tiles skip more and cost more",
        evidence: format!("{}: {}", scene.name(), text.join("; ")),
        holds: found.windows(2).all(|pair| pair[1].1 < pair[0].1 && pair[1].2 > pair[0].2),
    })
}
