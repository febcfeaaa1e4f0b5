//! Triangle-mesh mirrors compared with the quadrics they approximate.

use core::f64::consts::TAU;
use etendue_core::maths::f64::sin_cos;
use etendue_optics::front::{
    Curve, Front, FrontError, MeshMirror, Mirror, MirrorParameters, MirrorShape, Optic, Placement, Quadric,
    QuadricKind, Reflectance,
};
use etendue_optics::{Lens, PinholeParameters};
use etendue_projection::Raster;
use glam::{DVec2, DVec3};

const RADIUS_MM: f64 = 30.0;
const CONIC: f64 = -1.69;
const RIM_MM: f64 = 40.0;

/// Sag and outward normal of the hyperboloid.
fn surface(x: f64, y: f64) -> (DVec3, DVec3) {
    let r2 = x * x + y * y;
    let root = (1.0 - (1.0 + CONIC) * r2 / (RADIUS_MM * RADIUS_MM)).sqrt();
    let z = r2 / (RADIUS_MM * (1.0 + root));
    (DVec3::new(x, y, z), DVec3::new(x, y, (1.0 + CONIC) * z - RADIUS_MM).normalize())
}

/// The hyperboloid in rings of triangles, `spokes` around.
fn mesh(rings: u32, spokes: u32, with_normals: bool) -> MeshMirror {
    let point = |ring: u32, spoke: u32| {
        let (s, c) = sin_cos(TAU * f64::from(spoke) / f64::from(spokes));
        let r = RIM_MM * f64::from(ring) / f64::from(rings);
        surface(r * c, r * s)
    };
    let rest = (1..=rings).flat_map(|ring| (0..spokes).map(move |spoke| (ring, spoke)));
    let corners: Vec<_> = core::iter::once(point(0, 0)).chain(rest.map(|(ring, spoke)| point(ring, spoke))).collect();
    let at = |ring: u32, spoke: u32| if ring == 0 { 0 } else { 1 + (ring - 1) * spokes + spoke % spokes };
    // Counter-clockwise as seen from −z.
    let quad = |ring: u32, spoke: u32| {
        let (a, b) = (at(ring, spoke), at(ring, spoke + 1));
        let (c, d) = (at(ring + 1, spoke), at(ring + 1, spoke + 1));
        if ring == 0 { vec![[a, d, c]] } else { vec![[a, d, c], [a, b, d]] }
    };
    let triangles = (0..rings).flat_map(|ring| (0..spokes).flat_map(move |spoke| quad(ring, spoke))).collect();
    let (positions, normals): (Vec<_>, Vec<_>) = corners.into_iter().unzip();
    MeshMirror::new(positions, if with_normals { normals } else { vec![] }, triangles).expect("a mesh")
}

fn front(shape: MirrorShape, degrees: [f64; 3]) -> Front {
    let placement = Placement::with_rotation_deg(DVec3::new(0.0, 0.0, 100.0), degrees);
    let reflectance = Reflectance::Fraction(Curve::Constant(1.0));
    let mirror = Mirror::new(MirrorParameters { shape, placement, reflectance }).expect("a mirror");
    Front::new(None, Some(Optic::Mirror(Box::new(mirror)))).expect("a mirror")
}

fn lens() -> Lens {
    Lens::pinhole(PinholeParameters { focal_length_mm: 5.3, f_number: 4.0, transmittance: 1.0 }).expect("a lens")
}

/// Largest and mean angle between the directions of the mesh and of the quadric, rad, over the inner nine tenths.
fn errors(mesh: MeshMirror) -> (f64, f64) {
    let quadric = QuadricKind::Conic { radius_mm: RADIUS_MM, conic: CONIC };
    let exact = front(MirrorShape::Quadric(Quadric::new(quadric, RIM_MM, 0.0).expect("a mirror")), [0.0; 3]);
    let (mesh, lens) = (front(MirrorShape::Mesh(Box::new(mesh)), [0.0; 3]), lens());
    let (mut maximum, mut sum) = (0.0_f64, 0.0);
    for i in 1..=2000 {
        let (s, c) = sin_cos(2.4 * f64::from(i));
        let at = DVec2::new(c, s) * (1.55 * (f64::from(i) / 2000.0).sqrt());
        let rays = |front: &Front| {
            let ray = front.ray(&lens, at, DVec2::splat(0.5), 550.0).expect("light");
            assert!(ray.mirror_m.is_some(), "a leak at {at}");
            ray.ray.direction
        };
        let apart = (rays(&mesh) - rays(&exact)).length();
        (maximum, sum) = (maximum.max(apart), sum + apart);
    }
    (maximum, sum / 2000.0)
}

#[test]
fn a_mesh_shows_what_the_quadric_shows_to_the_square_of_its_triangles() {
    for with_normals in [true, false] {
        let [coarse, middle, fine] = [12, 24, 48].map(|rings| errors(mesh(rings, 4 * rings, with_normals)));
        for (a, b) in [(coarse, middle), (middle, fine)] {
            // Half the size gives a quarter of the error; the largest error also depends on the sample positions.
            assert!((3.4..4.8).contains(&(a.1 / b.1)), "{with_normals}: mean {a:?} {b:?}");
            // At the edge, mean normals of triangles on one side only have a first-order error.
            assert!(!with_normals || (2.4..6.0).contains(&(a.0 / b.0)), "largest {a:?} {b:?}");
        }
        assert!(coarse.1 < 0.01, "{with_normals}: {coarse:?}");
    }
}

#[test]
fn nothing_leaks_through_edges_and_corners() {
    let (front, lens) = (front(MirrorShape::Mesh(Box::new(mesh(6, 8, true))), [0.0; 3]), lens());
    // Rays straight at the corners and along the edges of the mesh.
    for ring in 0..48 {
        for spoke in 0..64 {
            let (s, c) = sin_cos(TAU * f64::from(spoke) / 64.0);
            // Within the octagon of the outer edge.
            let r = RIM_MM * 0.85 * f64::from(ring) / 48.0;
            let (p, _) = surface(r * c, r * s);
            let at = p.truncate() / (p.z + 100.0) * 5.3;
            let ray = front.ray(&lens, at, DVec2::splat(0.5), 550.0).expect("light");
            assert!(ray.mirror_m.is_some(), "a leak at ring {ring}, spoke {spoke}");
        }
    }
}

#[test]
fn meshes_that_are_no_mirror_are_refused() {
    let [a, b, c] = [DVec3::ZERO, DVec3::X, DVec3::Y];
    let refused = |positions, triangles| MeshMirror::new(positions, vec![], triangles).expect_err("none").to_string();
    assert!(refused(vec![a, b, c], vec![]).contains("no triangles"));
    assert!(refused(vec![a, b, c], vec![[0, 1, 3]]).contains("missing vertex"));
    assert!(refused(vec![a, b, b], vec![[0, 1, 2]]).contains("without area"));
    let raster = Raster::new(80, 80, DVec2::splat(0.05), DVec2::splat(40.0)).expect("a raster");
    let back = front(MirrorShape::Mesh(Box::new(mesh(6, 8, true))), [180.0, 0.0, 0.0]);
    assert_eq!(back.check(&lens(), &raster), Err(FrontError::SeenFromInside));
}
