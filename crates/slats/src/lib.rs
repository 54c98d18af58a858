//! Slats: one new image every NTSC field on Pixel-Planes 5.
