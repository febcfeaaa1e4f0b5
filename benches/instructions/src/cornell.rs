//! The Cornell box as the tracer sees it: eight instances of two meshes, three grey levels and a lamp.

use core::f64::consts::FRAC_PI_2;
use etendue_core::{Motion, WavelengthRange};
use etendue_spectra::{Extrapolation, Spectrum};
use etendue_tracer::MaterialId;
use etendue_tracer::accel::{World, WorldBuilder};
use etendue_tracer::geometry::{Instance, Mesh, Shape};
use etendue_tracer::lights::{Lights, Sources};
use etendue_tracer::materials::{Emission, EmissionSides, Material, MaterialTable, Reflectance, Surface};
use etendue_tracer::render_space::RenderSpace;
use glam::{DAffine3, DQuat, DVec3, Vec3};

const WHITE: MaterialId = MaterialId(0);
const RED: MaterialId = MaterialId(1);
const GREEN: MaterialId = MaterialId(2);
const LAMP: MaterialId = MaterialId(3);

/// World and materials.
pub(crate) struct Cornell {
    pub(crate) world: World,
    pub(crate) materials: MaterialTable,
}

impl Cornell {
    pub(crate) fn new() -> Self {
        let mut builder = WorldBuilder::new();
        let quad = builder.add_mesh(quad());
        let cuboid = builder.add_mesh(cuboid());
        let up = |deg: f64| DQuat::from_rotation_z(deg.to_radians());
        let parts = [
            (quad, DVec3::new(0.5592, 0.556, 1.0), DQuat::IDENTITY, DVec3::new(0.2796, 0.278, 0.0), WHITE),
            (quad, DVec3::new(0.5592, 0.556, 1.0), DQuat::IDENTITY, DVec3::new(0.2796, 0.278, 0.5488), WHITE),
            (
                quad,
                DVec3::new(0.5488, 0.556, 1.0),
                DQuat::from_rotation_y(FRAC_PI_2),
                DVec3::new(0.5592, 0.278, 0.2744),
                WHITE,
            ),
            (
                quad,
                DVec3::new(0.5592, 0.5488, 1.0),
                DQuat::from_rotation_x(FRAC_PI_2),
                DVec3::new(0.2796, 0.556, 0.2744),
                RED,
            ),
            (
                quad,
                DVec3::new(0.5592, 0.5488, 1.0),
                DQuat::from_rotation_x(FRAC_PI_2),
                DVec3::new(0.2796, 0.0, 0.2744),
                GREEN,
            ),
            (cuboid, DVec3::new(0.167, 0.1648, 0.165), up(-16.7), DVec3::new(0.169, 0.1855, 0.0825), WHITE),
            (cuboid, DVec3::new(0.1673, 0.1654, 0.33), up(17.03), DVec3::new(0.35125, 0.3685, 0.165), WHITE),
            (
                quad,
                DVec3::new(0.105, 0.13, 1.0),
                DQuat::from_rotation_x(2.0 * FRAC_PI_2),
                DVec3::new(0.2795, 0.278, 0.5478),
                LAMP,
            ),
        ];
        for (number, (mesh, size, turn, position, material)) in (1..).zip(parts) {
            builder.add_instance(Instance {
                shape: Shape::Mesh(mesh),
                to_world: Motion::constant(DAffine3::from_scale_rotation_translation(size, turn, position)),
                materials: vec![material],
                instance_id: number,
                semantic_id: 1,
            });
        }
        let world = builder.build().expect("a world");
        Self { world, materials: MaterialTable::new(materials(), vec![]).expect("materials") }
    }

    pub(crate) fn lights(&self, view: &RenderSpace<'_>) -> Lights {
        Lights::new(view, &self.materials, Sources::default(), WavelengthRange { low_nm: 400.0, high_nm: 700.0 })
            .expect("lights")
    }
}

fn materials() -> Vec<Material> {
    let nm = [400.0, 550.0, 700.0];
    let table = |values: [f64; 3]| [0, 1, 2].map(|i| (nm[i], values[i]));
    let spectrum = |values| Spectrum::from_points(&table(values), Extrapolation::Hold).expect("a table");
    let diffuse = |values| Material::new(Surface::from(Reflectance::Spectrum(spectrum(values))));
    let emission =
        Emission { radiance: spectrum([0.1, 0.4, 0.7]), factor: None, sides: EmissionSides::Front, modulation: None };
    let lamp = Material { emission: Some(emission), ..diffuse([0.78; 3]) };
    vec![diffuse([0.5, 0.75, 0.74]), diffuse([0.05, 0.06, 0.64]), diffuse([0.1, 0.45, 0.14]), lamp]
}

/// A square of side 1 about the origin, facing up.
fn quad() -> Mesh {
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| Vec3::new(x, y, 0.0));
    mesh(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]])
}

/// A cube of edge 1 about the origin.
fn cuboid() -> Mesh {
    let corner = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) - 0.5;
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles = faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect();
    mesh((0..8).map(corner).collect(), triangles)
}

fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    Mesh::new(positions, vec![], vec![], triangles, vec![]).expect("a mesh").0
}
