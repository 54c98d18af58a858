//! Cycle-accurate emulator of Pixel-Planes 5.
