//! Meshes, spheres, importers, built-in scenes, camera and head motion.
