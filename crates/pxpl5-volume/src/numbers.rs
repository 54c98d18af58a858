//! All numbers in the settings of a volume, except the numbers of the display and of the time model.

pxpl5_sim::parameters::parameter_table! {
    /// Offset and bias of the methods that clip to a slice, and the precision of their planes.
    pub struct ClipNumbers {
        /// Distance by which the tapered and the parallel clip move planes outwards.
        offset_px: f64 = 0.5, "px", Assumed, 0.0..=2.0 in 0.0..=4096.0, "half a pixel, so that no slab is thinner than one";
        /// Constant that the hyperbolic clip adds to the product of the distances from both planes.
        bias_px2: f64 = 0.25, "px^2", Assumed, 0.0..=4.0 in 0.0..=16777216.0, "the square of the offset";
        /// Number of fraction bits with which plane equations are evaluated. 53 means double precision.
        plane_fraction_bits: 53, "bits", Assumed, 4..=53 in 0..=53, "the paper gives no value; fewer bits widen the dead zone";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Parameters of the jittered projection, which gives each slice a random eye position and a random shear.
    pub struct JitterNumbers {
        /// Distance of the eye from the slice.
        eye_distance: f64 = 4.0, "radii", Assumed, 2.0..=16.0 in 0.001..=1000000.0, "the paper gives no value";
        /// Radius of the disc in which the random position of the eye lies.
        eye_radius: f64 = 0.5, "radii", Assumed, 0.0..=1.0 in 0.0..=1000.0, "the paper gives no value";
        /// Greatest shift of a point by the shear, at the near or far plane of the slice.
        shear_px: f64 = 0.5, "px", Assumed, 0.0..=1.0 in 0.0..=1000.0, "the paper states a shift of less than a pixel";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Position and shear of the perspective eye, which is the same for all slices.
    pub struct EyeNumbers {
        /// Horizontal position of the perspective eye in the slice's coordinates.
        across_px: f64 = 0.0, "px", Assumed, -384.0..=384.0 in -1000000.0..=1000000.0, "on the axis";
        /// Vertical position of the perspective eye in the slice's coordinates.
        up_px: f64 = 0.0, "px", Assumed, -384.0..=384.0 in -1000000.0..=1000000.0, "in the middle";
        /// Distance of the perspective eye from the slice.
        distance: f64 = 4.0, "radii", Assumed, 2.0..=16.0 in 0.001..=1000000.0, "the same as with jitter";
        /// Horizontal shear of the perspective projection, in pixels per pixel of distance from the slice.
        shear_across: f64 = 0.0, "1", Assumed, -0.2..=0.2 in -1000.0..=1000.0, "none";
        /// Vertical shear of the perspective projection, in pixels per pixel of distance from the slice.
        shear_up: f64 = 0.0, "1", Assumed, -0.2..=0.2 in -1000.0..=1000.0, "none";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Size of the tiles, and number of slices in a batch of queries.
    pub struct TileNumbers {
        /// Side of a tile. With 0 there are no tiles: every pixel is packed and sent.
        size: 32, "px", Published, 32..=32 in 0..=4096, "the SpatialGL paper (P16)";
        /// Number of slices that share a stencil clear and the queries of tiles.
        batch: 4, "slices", Published, 4..=4 in 1..=65536, "the SpatialGL paper (P18)";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// Parameters of sampling and halftoning.
    pub struct DrawNumbers {
        /// Number of samples per pixel.
        samples: 1, "samples", Published, 1..=1 in 1..=16, "the SpatialGL paper rejects more samples as too expensive; 4 and 16 for comparison";
        /// Number of rows and columns of the dither matrix.
        matrix: 8, "px", Assumed, 2..=16 in 2..=16, "the paper gives no value";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// The angle at which the screen begins a turn.
    pub struct SweepNumbers {
        /// Angle of slice 0 around the axis.
        phase_deg: f64 = 0.0, "deg", Assumed, 0.0..=360.0 in -360.0..=360.0, "the paper gives no value";
    }
}

pxpl5_sim::parameters::parameter_table! {
    /// The viewer in front of the display, and the head-mounted display with which the volume is compared.
    pub struct ViewerNumbers {
        /// Diameter of the displayed volume.
        diameter_mm: f64 = 254.0, "mm", Assumed, 200.0..=500.0 in 1.0..=100000.0, "the paper gives no value; 768 px over 10 inches in SPIE 4297";
        /// Distance from the head to the middle of the volume at the beginning of a motion.
        distance_mm: f64 = 508.0, "mm", Assumed, 300.0..=2000.0 in 1.0..=1000000.0, "four radii, the same as other views";
        /// Distance between both eyes.
        eye_separation_mm: f64 = 64.0, "mm", Assumed, 54.0..=74.0 in 0.0..=1000.0, "mean of adults, as hmd.eye_distance";
        /// Width of the head-mounted display's picture, whose height is three quarters of the width.
        hmd_width_px: 640, "px", Published, 640..=640 in 8..=16000, "TR94: 640 x 480";
        /// Viewing angle between the left and the right edge of the head-mounted display's picture.
        hmd_angle_deg: f64 = 60.0, "deg", Assumed, 30.0..=100.0 in 1.0..=170.0, "published in JITP's example";
    }
}
