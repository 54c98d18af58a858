//! Transform, clip, edge and plane equations and binning for Pixel-Planes 5.
