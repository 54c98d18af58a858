//! The time of a volume, from a model of processor, GPU and bus. All parameters of the time model are in this module.

use crate::projection::Size;
use crate::stats::VolumeStats;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use serde::Serialize;

pxpl5_sim::parameters::parameter_table! {
    /// The preset `geforce-6800`: a GPU, a processor and a bus of 2005. The SpatialGL paper does not name its hardware.
    pub struct GpuTiming {
        /// Number of fragments that the GPU fills per second.
        fill_mpixels: 6_400, "Mpixel/s", Published, 6400..=6400 in 1..=MAX, "GeForce 6800 Ultra (SPIE 5664 names the board)";
        /// Number of texels that the GPU reads per second.
        texel_mtexels: 6_400, "Mtexel/s", Published, 6400..=6400 in 1..=MAX, "GeForce 6800 Ultra";
        /// Number of vertices that the GPU transforms per second.
        vertex_mvertices: 600, "Mvertex/s", Published, 600..=600 in 1..=MAX, "GeForce 6800 Ultra";
        /// Rate of transfers from the GPU to the host, and also from the host to the projector.
        readback_mb_s: 200, "MB/s", Assumed, 100..=1000 in 1..=MAX, "AGP has a low rate from the GPU to the host";
        /// Time of one occlusion query, without the time to fill the query's pixels.
        query_ns: 2_000, "ns", Assumed, 500..=10000 in 0..=MAX, "a call of the driver";
        /// Time of the driver calls for one pass of one slice.
        call_ns: 2_000, "ns", Assumed, 500..=10000 in 0..=MAX, "a call of the driver";
        /// Processor time to transform one vertex and compute its bin code.
        vertex_ns: 20, "ns", Assumed, 2..=50 in 0..=MAX, "Athlon 64";
        /// Processor time to find the bins of one primitive.
        primitive_ns: 10, "ns", Assumed, 2..=50 in 0..=MAX, "Athlon 64";
        /// Processor time to pass one primitive of a bin to the GPU.
        issue_ns: 10, "ns", Assumed, 2..=50 in 0..=MAX, "indexed arrays";
    }
}

/// The time model. Its times are linear functions of the counts of a volume:
///
/// ```text
/// CPU  vertices t_vertex + primitives t_primitive + slices passes t_call + draws t_issue
/// GPU  3 draws / vertex rate + fragments generated / fill + W H (slices + batches) / fill
///      + queries t_query + queries tile^2 / fill + pixels packed / texel rate
///      (every pixel of a target counts for each of its samples, if there are several)
/// bus  bytes sent / readback, and the same to the projector
/// ```
///
/// A transfer of unpacked pixels takes 4 bytes per pixel, and needs no time for packing.
#[derive(Clone, Copy, Debug)]
pub struct TimeModel {
    pub timing: GpuTiming,
}

/// The time of one volume for each component of the hardware, in milliseconds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VolumeTime {
    /// Processor time for vertices, sorting into bins, and driver calls.
    pub cpu_ms: f64,
    /// GPU time for vertices, fragments, clears, queries and packing.
    pub gpu_ms: f64,
    /// Bus time for reading back from the GPU.
    pub readback_ms: f64,
    /// Bus time for sending the pixels to the projector, after they were read back from the GPU. Equal to
    /// `readback_ms`, because the number of bytes is equal.
    pub projector_ms: f64,
}

impl VolumeTime {
    /// Returns the bus time: reading back from the GPU, then sending to the projector.
    pub fn bus_ms(&self) -> f64 {
        self.readback_ms + self.projector_ms
    }

    /// Returns the number of volumes per second if processor, GPU and bus work one after the other.
    pub fn serial_hz(&self) -> f64 {
        1e3 / (self.cpu_ms + self.gpu_ms + self.bus_ms())
    }

    /// Returns the number of volumes per second if processor, GPU and bus work at the same time on different volumes.
    pub fn overlapped_hz(&self) -> f64 {
        1e3 / self.cpu_ms.max(self.gpu_ms).max(self.bus_ms())
    }
}

impl TimeModel {
    /// The preset `geforce-6800`, the hardware of 2005.
    pub const GEFORCE_6800: Self = Self { timing: GpuTiming::PAPERS };

    /// Creates a time model with these rates and times of the hardware.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] for the first number that the model cannot use.
    pub fn new(timing: GpuTiming) -> Result<Self, SettingError> {
        ParameterTable::check(&timing)?;
        Ok(Self { timing })
    }

    /// Returns the time of a volume with these counts if occupied tiles are packed and sent.
    pub fn packed(&self, stats: &VolumeStats, size: Size, tile: u32) -> VolumeTime {
        let packing_ms = millions_ms(stats.pixels_packed * stats.samples.max(1), self.timing.texel_mtexels);
        let gpu_ms = self.gpu_ms(stats, size, tile) + packing_ms;
        self.with_bus(stats, gpu_ms, stats.bytes_sent)
    }

    /// Returns the time of a volume with these counts if all pixels are sent as 32-bit words, without queries.
    pub fn unpacked(&self, stats: &VolumeStats, size: Size) -> VolumeTime {
        let unqueried = VolumeStats { queries: 0, stencil_clears: 0, ..stats.clone() };
        let gpu_ms = self.gpu_ms(&unqueried, size, 0);
        self.with_bus(stats, gpu_ms, stats.bytes_unpacked)
    }

    fn cpu_ms(&self, stats: &VolumeStats) -> f64 {
        let GpuTiming { vertex_ns, primitive_ns, call_ns, issue_ns, .. } = self.timing;
        let calls = stats.slices_rendered * stats.passes;
        let ns =
            stats.vertices * vertex_ns + stats.primitives * primitive_ns + calls * call_ns + stats.draws * issue_ns;
        ns as f64 / 1e6
    }

    fn gpu_ms(&self, stats: &VolumeStats, size: Size, tile: u32) -> f64 {
        let timing = &self.timing;
        // Every pixel of a target counts once for each of its samples.
        let pixels = u64::from(size[0]) * u64::from(size[1]) * stats.samples.max(1);
        let cleared = pixels * (stats.slices_rendered + stats.stencil_clears);
        let queried = stats.queries * u64::from(tile) * u64::from(tile) * stats.samples.max(1);
        millions_ms(3 * stats.draws, timing.vertex_mvertices)
            + millions_ms(stats.fragments_generated + cleared + queried, timing.fill_mpixels)
            + (stats.queries * timing.query_ns) as f64 / 1e6
    }

    fn with_bus(&self, stats: &VolumeStats, gpu_ms: f64, bytes: u64) -> VolumeTime {
        let one_way_ms = millions_ms(bytes, self.timing.readback_mb_s);
        VolumeTime { cpu_ms: self.cpu_ms(stats), gpu_ms, readback_ms: one_way_ms, projector_ms: one_way_ms }
    }
}

/// Returns the time in milliseconds of `count` operations. The rate is given in millions per second.
fn millions_ms(count: u64, millions: u64) -> f64 {
    count as f64 / (millions as f64 * 1e3)
}
