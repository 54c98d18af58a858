//! NTSC double-buffered frame buffer and video timing of Pixel-Planes 5.
