//! Graphics processor board of Pixel-Planes 5: memory, ring port, firmware host.
