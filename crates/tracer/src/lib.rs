//! Geometry, accelerator, materials, lights and integrators: rays in, spectral radiance out.
