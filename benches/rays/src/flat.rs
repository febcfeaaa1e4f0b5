//! A world's instances written out as one mesh: what the accelerator does without instances.

use etendue_core::Motion;
use etendue_tracer::MaterialId;
use etendue_tracer::accel::{World, WorldBuilder};
use etendue_tracer::geometry::{Instance, Mesh, Shape};
use etendue_tracer::render_space::RenderSpace;
use glam::{DAffine3, Vec3};

/// All triangles of a view in one mesh, in the render frame. Spheres are left out.
pub fn mesh(view: &RenderSpace<'_>) -> Mesh {
    mesh_from_corners(instances(view).flat_map(|i| triangles(view, i)).flatten().collect())
}

/// A mesh of triangles that share no corners: three corners each.
pub fn mesh_from_corners(corners: Vec<Vec3>) -> Mesh {
    let triangles = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh::new(corners, vec![], vec![], triangles, vec![]).expect("triangles of a legal world").0
}

/// A world of one mesh.
pub fn world(mesh: Mesh) -> World {
    let mut builder = WorldBuilder::new();
    let shape = Shape::Mesh(builder.add_mesh(mesh));
    let to_world = Motion::constant(DAffine3::IDENTITY);
    builder.add_instance(Instance { shape, to_world, materials: vec![MaterialId(0)], instance_id: 1, semantic_id: 0 });
    builder.build().expect("a legal world")
}

fn instances<'w>(view: &RenderSpace<'w>) -> impl Iterator<Item = u32> + use<'w> {
    let shapes = view.world().instances().iter().enumerate();
    shapes.filter(|(_, instance)| matches!(instance.shape, Shape::Mesh(_))).map(|(i, _)| i as u32)
}

fn triangles<'a>(view: &'a RenderSpace<'_>, instance: u32) -> impl Iterator<Item = [Vec3; 3]> + 'a {
    (0..view.primitive_count(instance)).map(move |primitive| view.triangle(instance, primitive, 0.0))
}
