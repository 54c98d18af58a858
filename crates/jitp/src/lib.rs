//! Just-in-time pixels: scan-out-synchronous rendering on Pixel-Planes 5.
