//! The 8-channel ring network of Pixel-Planes 5.
