//! Tests of scenes and their files.

// Built-in scenes, motion, and changes of models.
mod decimate;
mod fit;
mod motion;
mod normals;
mod scenes;

// Files.
mod foreign;
mod gltf;
mod import;
mod stl;
