//! Meshes, textures, spectral and ground-truth EXR, PNG and side-car files.
