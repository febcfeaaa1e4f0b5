//! A mirror in front of the lens.

use super::super::context::Context;
use super::super::material::complex_index;
use super::curve;
use etendue_optics::front::{
    FrontError, MeshMirror, Mirror, MirrorParameters, MirrorShape, Placement, Quadric, QuadricKind, Reflectance,
};
use etendue_scene::record::front::mirror::{self as record, Edges, Finish, MirrorShape as Shape};
use glam::DVec3;

pub(super) fn mirror(r: &record::Mirror, context: &mut Context<'_>) -> Option<Mirror> {
    let reflectance = reflectance(&r.finish, context);
    let (shape, usual_mm) = shape(&r.shape, context)?;
    // A mirror that was read has a distance, or is a hyperboloid.
    let distance_mm = r.distance_mm.as_ref().map(|d| d.value).or(usual_mm)?;
    let [x, y] = r.offset_mm.as_ref().map_or([0.0; 2], |o| o.value);
    let degrees = r.rotation_deg.as_ref().map_or([0.0; 3], |d| d.value);
    let placement = Placement::turned(DVec3::new(x, y, distance_mm), degrees);
    context.accept(&r.place, Mirror::new(MirrorParameters { shape, placement, reflectance: reflectance? }))
}

/// The surface, and where its vertex stands if it is not said.
fn shape(r: &Shape, context: &mut Context<'_>) -> Option<(MirrorShape, Option<f64>)> {
    let (place, made) = match r {
        Shape::Sphere(s) => (&s.place, conic(s.radius_mm.value, 0.0, &s.edges)),
        Shape::Paraboloid(s) => (&s.place, conic(s.radius_mm.value, -1.0, &s.edges)),
        Shape::Hyperboloid(h) => (&h.place, conic(h.radius_mm.value, h.conic.value, &h.edges)),
        Shape::Cone(c) => (&c.place, quadric(QuadricKind::Cone { half_angle_deg: c.half_angle_deg.value }, &c.edges)),
        Shape::Mesh(mesh) => return Some((MirrorShape::Mesh(Box::new(self::mesh(mesh, context)?)), None)),
    };
    let quadric = context.accept(place, made)?;
    Some((MirrorShape::Quadric(quadric), quadric.outer_focus_mm()))
}

fn mesh(r: &record::MeshFile, context: &mut Context<'_>) -> Option<MeshMirror> {
    let Some(asset) = context.assets.meshes.get(&r.file.value) else {
        context.fault(&r.file.place, "the mesh was not loaded", "give a readable file");
        return None;
    };
    let scale = r.scale_mm.as_ref().map_or(1.0, |s| s.value);
    let vector = |v: &[f32; 3]| DVec3::from_array(v.map(f64::from));
    let origin = DVec3::from_array(asset.origin);
    let positions = asset.positions.iter().map(|p| (vector(p) + origin) * scale).collect();
    let normals = asset.normals.iter().map(vector).collect();
    context.accept(&r.file.place, MeshMirror::new(positions, normals, asset.triangles.clone()))
}

fn conic(radius_mm: f64, conic: f64, edges: &Edges) -> Result<Quadric, FrontError> {
    quadric(QuadricKind::Conic { radius_mm, conic }, edges)
}

fn quadric(kind: QuadricKind, edges: &Edges) -> Result<Quadric, FrontError> {
    Quadric::new(kind, edges.rim_radius_mm.value, edges.hole_radius_mm.as_ref().map_or(0.0, |h| h.value))
}

fn reflectance(finish: &Finish, context: &mut Context<'_>) -> Option<Reflectance> {
    match (finish, finish.metal()) {
        (Finish::Share(colour), _) => curve(colour, context).map(Reflectance::Share),
        (_, metal) => complex_index(&metal?, context).map(|index| Reflectance::Metal(Box::new(index))),
    }
}
