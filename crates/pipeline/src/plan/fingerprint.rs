//! The hash of a plan: everything that decides its result, and nothing else (no path, no thread count, no tile size).

use crate::plan::{CameraBody, CameraPlan, Plan, Settings};
use etendue_optics::DepthOfField;
use etendue_scene::asset::Assets;
use etendue_tracer::geometry::Mesh;
use sha2::{Digest, Sha256};
use std::fmt::{Debug, Write};

/// Feeds texts and bytes to the hash.
struct Hasher(Sha256);

impl Write for Hasher {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

impl Hasher {
    /// Adds a value by its `Debug` text, which shows every float so that it reads back to the same bits.
    fn add(&mut self, value: &impl Debug) {
        // Writing to a hash does not fail.
        let _ = writeln!(self, "{value:?}");
    }

    /// Pictures and tables by their content: `Debug` texts leave texels out.
    fn add_assets(&mut self, assets: &Assets) {
        let hashes = |of: &mut dyn Iterator<Item = [u8; 32]>| of.collect::<Vec<_>>();
        self.add(&hashes(&mut assets.images.values().map(|image| image.hash)));
        self.add(&hashes(&mut assets.spectra.values().map(|spectrum| spectrum.hash)));
        self.add(&hashes(&mut assets.photometry.values().map(|lamp| lamp.hash)));
        self.add(&hashes(&mut assets.indices.values().map(|table| table.hash)));
        self.add(&hashes(&mut assets.retro_tables.values().map(|table| table.hash)));
        // Lenses and calibrations are in the cameras, whole.
    }

    fn add_mesh(&mut self, mesh: &Mesh) {
        let counts = [mesh.positions().len(), mesh.normals().len(), mesh.uvs().len(), mesh.triangles().len()];
        self.add(&counts);
        self.0.update(bytemuck::cast_slice(mesh.positions()));
        self.0.update(bytemuck::cast_slice(mesh.normals()));
        self.0.update(bytemuck::cast_slice(mesh.uvs()));
        self.0.update(bytemuck::cast_slice(mesh.triangles()));
        self.0.update(bytemuck::cast_slice(mesh.slots()));
        // Nothing is added for meshes near their file's origin.
        if mesh.origin() != glam::DVec3::ZERO {
            self.add(&mesh.origin());
        }
    }

    fn add_camera(&mut self, camera: &CameraPlan) {
        let CameraBody { place: _, raster, lens, front, effects, aperture_px, sensor, development } = &camera.body;
        self.add(&(&camera.name, camera.index, camera.pose, camera.products));
        self.add(&(raster, lens, aperture_px, sensor, development));
        // Nothing is added where light is a camera's own.
        if !camera.owns_light() {
            self.add(&camera.light.index);
        }
        // A camera without effects is what it was before there were any.
        if !effects.is_idle() {
            self.add(effects);
        }
        front.iter().for_each(|front| self.add(front));
        // Nor is one that blurs nothing in image space.
        if camera.depth_of_field != DepthOfField::None {
            self.add(&camera.depth_of_field);
        }
        // The size of a tile does not change the result.
        self.add(&Settings { tile_px: 0, ..camera.settings });
    }
}

/// SHA-256 of all that decides the plan's result, the program's version included.
pub(crate) fn fingerprint(plan: &Plan, assets: &Assets) -> [u8; 32] {
    let mut hasher = Hasher(Sha256::new());
    hasher.add(&env!("CARGO_PKG_VERSION"));
    hasher.add_assets(assets);
    plan.world.meshes().iter().for_each(|mesh| hasher.add_mesh(mesh));
    hasher.add(&plan.world.instances());
    hasher.add(&plan.material_table);
    hasher.add(&plan.sources);
    plan.cameras.iter().for_each(|camera| hasher.add_camera(camera));
    hasher.0.finalize().into()
}
