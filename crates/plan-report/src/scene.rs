//! Content of the scene.

use etendue_pipeline::Plan;
use etendue_pipeline::report::{MeshSize, mesh_sizes};
use etendue_tracer::geometry::Shape;

/// Content of the scene.
#[derive(Clone, Debug, serde::Serialize)]
pub struct SceneReport {
    /// Instances of objects.
    pub instances: usize,
    /// Triangles of all instances.
    pub triangles: usize,
    /// Stored triangles: those of each mesh once.
    pub stored_triangles: usize,
    /// Meshes of named objects; boxes and flat shapes are omitted.
    pub meshes: Vec<MeshReport>,
    pub spheres: usize,
    pub materials: usize,
    /// Image textures.
    pub textures: usize,
    /// Participating media: fog, including that of rain or snow.
    pub media: usize,
    /// True if there is precipitation.
    pub precipitation: bool,
    /// True if the strength of any light varies over time.
    pub lights_change: bool,
    /// A clear sky; `None` for other surroundings.
    pub sky: Option<SkyReport>,
}

/// A mesh in the scene.
#[derive(Clone, Debug, serde::Serialize)]
pub struct MeshReport {
    /// The first object with this mesh.
    pub object: String,
    /// Number of objects with this mesh.
    pub objects: usize,
    pub triangles: usize,
    /// Length, width and height of the first object along its own axes (x forward, y left, z up), m.
    pub size_m: [f64; 3],
}

/// A clear sky.
#[derive(Clone, Copy, Debug, serde::Serialize)]
pub struct SkyReport {
    /// Turbidity of the air.
    pub turbidity: f64,
    /// Elevation of the sun's centre, degrees.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun's centre from +x towards +y, degrees.
    pub sun_azimuth_deg: f64,
    /// Illuminance of horizontal ground by the sky, lx.
    pub sky_lx: f64,
    /// Illuminance of horizontal ground by the sky's sun, lx; 0 if the sun is disabled or below the horizon.
    pub sun_lx: f64,
}

impl SceneReport {
    pub(super) fn new(plan: &Plan) -> Self {
        let instances = plan.world.instances();
        let triangles = |shape: &Shape| match shape {
            Shape::Mesh(id) => plan.world.mesh(*id).triangles().len(),
            Shape::Sphere { .. } => 0,
        };
        Self {
            instances: instances.len(),
            triangles: instances.iter().map(|instance| triangles(&instance.shape)).sum(),
            stored_triangles: plan.world.meshes().iter().map(|mesh| mesh.triangles().len()).sum(),
            meshes: mesh_sizes(plan)
                .into_iter()
                .map(|MeshSize { object, objects, triangles, size_m }| MeshReport {
                    object,
                    objects,
                    triangles,
                    size_m,
                })
                .collect(),
            spheres: instances.iter().filter(|instance| matches!(instance.shape, Shape::Sphere { .. })).count(),
            materials: plan.materials.len(),
            textures: plan.material_table.textures().len(),
            media: plan.media.len(),
            precipitation: plan.precipitation.is_some(),
            lights_change: plan.is_modulated(),
            sky: plan.sky.map(|sky| SkyReport {
                turbidity: sky.turbidity,
                sun_elevation_deg: sky.sun_elevation_deg,
                sun_azimuth_deg: sky.sun_azimuth_deg,
                sky_lx: sky.sky_lx,
                sun_lx: sky.sun_lx,
            }),
        }
    }
}
