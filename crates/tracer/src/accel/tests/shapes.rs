//! Closed meshes, worlds and random numbers for tests.

use crate::MaterialId;
use crate::accel::{World, WorldBuilder};
use crate::geometry::{Instance, Mesh, Shape};
use etendue_core::Motion;
use etendue_core::random::{philox4x32, unit_f64};
use glam::{DAffine3, DMat3, DVec3, Vec3};
use std::collections::HashMap;

/// Reproducible numbers.
pub(crate) struct Random {
    seed: u32,
    count: u32,
}

impl Random {
    pub(crate) fn new(seed: u32) -> Self {
        Self { seed, count: 0 }
    }

    /// In [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        self.count += 1;
        let words = philox4x32([self.count, 0, 0, 0], [self.seed, 0]);
        unit_f64(u64::from(words[0]) << 32 | u64::from(words[1]))
    }

    /// In [low, high).
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// In the cube [−1, 1)³.
    pub(crate) fn cube(&mut self) -> DVec3 {
        DVec3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), self.between(-1.0, 1.0))
    }

    /// On the unit sphere.
    pub(crate) fn direction(&mut self) -> DVec3 {
        loop {
            let p = self.cube();
            if p.length_squared() > 1e-4 && p.length_squared() <= 1.0 {
                return p.normalize();
            }
        }
    }

    pub(crate) fn rotation(&mut self) -> DMat3 {
        let z = self.direction();
        let x = z.cross(self.direction()).normalize();
        DMat3::from_cols(x, z.cross(x), z)
    }
}

/// A mesh of positions and triangles alone, with nothing dropped.
pub(crate) fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> Mesh {
    let (mesh, dropped) = Mesh::new(positions, vec![], vec![], triangles, vec![]).expect("a legal mesh");
    assert_eq!((dropped.zero_area, dropped.duplicate), (0, 0));
    mesh
}

/// A sphere of triangles about the origin, radius 1.
pub(crate) fn icosphere(levels: u32) -> Mesh {
    let g = (1.0 + 5.0_f32.sqrt()) / 2.0;
    let mut positions: Vec<Vec3> = [(0.0, 1.0, g), (1.0, g, 0.0), (g, 0.0, 1.0)]
        .iter()
        .flat_map(|(x, y, z)| {
            [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(s, t)| match (x, y, z) {
                (0.0, y, z) => Vec3::new(0.0, y * s, z * t),
                (x, y, 0.0) => Vec3::new(x * s, y * t, 0.0),
                (x, _, z) => Vec3::new(x * s, 0.0, z * t),
            })
        })
        .map(Vec3::normalize)
        .collect();
    let mut triangles = hull(&positions);
    for _ in 0..levels {
        triangles = subdivide(&mut positions, &triangles);
    }
    mesh(positions, triangles)
}

/// The faces of a convex body of few vertices: triples with all others on one side.
fn hull(p: &[Vec3]) -> Vec<[u32; 3]> {
    let n = p.len();
    let mut faces = Vec::new();
    for (a, b, c) in (0..n).flat_map(|a| (a + 1..n).flat_map(move |b| (a + 1..n).map(move |c| (a, b, c)))) {
        let normal = (p[b] - p[a]).cross(p[c] - p[a]);
        if b != c && p.iter().all(|q| normal.dot(*q - p[a]) < 1e-4) {
            faces.push([a as u32, b as u32, c as u32]);
        }
    }
    faces
}

fn subdivide(positions: &mut Vec<Vec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = HashMap::new();
    let mut middle = |a: u32, b: u32| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            positions.push(((positions[a as usize] + positions[b as usize]) * 0.5).normalize());
            positions.len() as u32 - 1
        })
    };
    let four = |[a, b, c]: &[u32; 3]| {
        let (ab, bc, ca) = (middle(*a, *b), middle(*b, *c), middle(*c, *a));
        [[*a, ab, ca], [*b, bc, ab], [*c, ca, bc], [ab, bc, ca]]
    };
    triangles.iter().flat_map(four).collect()
}

/// A closed body over a grid: a bumpy top, walls, and a flat floor at z = −1. Grid points are at integers.
pub(crate) fn bumpy(cells: u32) -> Mesh {
    let mut random = Random::new(5);
    let row = cells + 1;
    let at = |x: u32, y: u32, z: f32| Vec3::new(x as f32, y as f32, z);
    let grid: Vec<_> = (0..row * row).map(|i| (i % row, i / row)).collect();
    let mut positions: Vec<_> = grid.iter().map(|(x, y)| at(*x, *y, random.between(0.0, 2.0) as f32)).collect();
    positions.extend(grid.iter().map(|(x, y)| at(*x, *y, -1.0)));
    let below = row * row;
    let mut triangles = Vec::new();
    for (x, y) in (0..cells).flat_map(|x| (0..cells).map(move |y| (x, y))) {
        let [a, b, c, d] = [y * row + x, y * row + x + 1, (y + 1) * row + x + 1, (y + 1) * row + x];
        triangles.extend([[a, b, c], [a, c, d], [below + a, below + c, below + b], [below + a, below + d, below + c]]);
    }
    for i in 0..cells {
        let sides = [
            (i, i + 1),
            (i + 1 + cells * row, i + cells * row),
            ((i + 1) * row, i * row),
            (i * row + cells, (i + 1) * row + cells),
        ];
        for (a, b) in sides {
            triangles.extend([[below + a, below + b, b], [below + a, b, a]]);
        }
    }
    mesh(positions, triangles)
}

/// A closed double cone along x, 100 long and 0.001 thick, of needles.
pub(crate) fn spindle() -> Mesh {
    let sides = 24_u32;
    let ring = |i: u32| {
        let (s, c) = etendue_core::maths::f32::sin_cos(i as f32 / sides as f32 * core::f32::consts::TAU);
        Vec3::new(0.0, c * 5e-4, s * 5e-4)
    };
    let mut positions: Vec<_> = (0..sides).map(ring).collect();
    positions.extend([Vec3::X * 50.0, Vec3::X * -50.0]);
    let around = |i: u32| [[i, (i + 1) % sides, sides], [(i + 1) % sides, i, sides + 1]];
    mesh(positions, (0..sides).flat_map(around).collect())
}

/// An instance of one material.
pub(crate) fn instance(shape: Shape, to_world: DAffine3) -> Instance {
    tracked(shape, Motion::constant(to_world))
}

/// As [`instance`], on a track.
pub(crate) fn tracked(shape: Shape, to_world: impl Into<Motion>) -> Instance {
    Instance { shape, to_world: to_world.into(), materials: vec![MaterialId(7)], instance_id: 11, semantic_id: 13 }
}

/// A world of one mesh, placed once.
pub(crate) fn world_of(mesh: Mesh, to_world: DAffine3) -> World {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh);
    builder.add_instance(instance(Shape::Mesh(id), to_world));
    builder.build().expect("a legal world")
}

/// The same world, and one with a second mesh far away, so that a view may merge both ([`super::super::merged`]).
pub(crate) fn alone_and_merged(mesh: Mesh, to_world: DAffine3) -> [World; 2] {
    let mut builder = WorldBuilder::new();
    let id = builder.add_mesh(mesh.clone());
    builder.add_instance(instance(Shape::Mesh(id), to_world));
    let speck = builder.add_mesh(soup(1, 5));
    let away = DVec3::new(0.4, 0.3, 0.87) * 1e8;
    builder.add_instance(instance(Shape::Mesh(speck), DAffine3::from_translation(away)));
    [world_of(mesh, to_world), builder.build().expect("a legal world")]
}

/// Triangles anywhere in the unit cube, of many sizes.
pub(crate) fn soup(count: u32, seed: u32) -> Mesh {
    let mut random = Random::new(seed);
    let corner = |_| {
        let (centre, size) = (random.cube(), random.between(0.02, 0.6));
        [0; 3].map(|_: i32| (centre + random.cube() * size).as_vec3())
    };
    let positions = (0..count).flat_map(corner).collect();
    mesh(positions, (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect())
}

/// A world of soups and spheres, rotated, stretched and mirrored.
pub(crate) fn mixed_world() -> World {
    let mut random = Random::new(77);
    let mut builder = WorldBuilder::new();
    let meshes = [soup(300, 1), soup(40, 2), icosphere(2), soup(1, 3)].map(|m| builder.add_mesh(m));
    for i in 0..24 {
        let stretch = DVec3::new(random.between(0.3, 2.0), random.between(0.3, 2.0), random.between(-2.0, -0.3));
        let matrix = random.rotation() * DMat3::from_diagonal(stretch);
        let shape = match i % 5 {
            4 => Shape::Sphere { radius_m: random.between(0.1, 1.0) },
            k => Shape::Mesh(meshes[k]),
        };
        builder.add_instance(instance(shape, DAffine3::from_mat3_translation(matrix, random.cube() * 4.0)));
    }
    builder.build().expect("a legal world")
}
