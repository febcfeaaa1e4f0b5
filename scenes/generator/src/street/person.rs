//! People in mid step, made of lofted limbs; 1.72 m high, looking towards +x.

use crate::mesh::Mesh;
use glam::{DAffine3, DMat3, DVec3};

const SIDES: usize = 8;

/// A walker in mid step (`stride` in m between the feet; 0 stands).
#[must_use]
pub(super) fn walker(stride: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let p = DVec3::new;
    let half = stride / 2.0;
    for (side, forward) in [(1.0, half), (-1.0, -half)] {
        let hip = p(0.0, 0.095 * side, 0.88);
        let knee = p(0.55 * forward + 0.03, 0.095 * side, 0.48);
        let heel = p(forward - 0.02, 0.09 * side, 0.09 + if forward < 0.0 { 0.05 } else { 0.0 });
        mesh.tube("trousers", &[(hip + DVec3::Z * 0.08, 0.05), (hip, 0.095), (knee, 0.065), (heel, 0.048)], SIDES);
        shoe(&mut mesh, heel);
        let shoulder = p(0.0, 0.20 * side, 1.40);
        let elbow = p(-0.4 * forward - 0.02, 0.25 * side, 1.13);
        let hand = p(-0.9 * forward + 0.06, 0.24 * side, 0.88);
        mesh.tube("coat", &[(shoulder + DVec3::Z * 0.05, 0.02), (shoulder, 0.065), (elbow, 0.05), (hand, 0.04)], SIDES);
        ball(&mut mesh, "skin", hand - DVec3::Z * 0.05, p(0.04, 0.025, 0.075));
    }
    let squash = DAffine3::from_mat3(DMat3::from_diagonal(p(0.62, 1.0, 1.0)));
    let coat = [[0.78, 0.0], [0.78, 0.20], [1.00, 0.175], [1.18, 0.185], [1.36, 0.21], [1.45, 0.16], [1.48, 0.07]];
    mesh.lathe("coat", squash, &coat, 12);
    mesh.tube("skin", &[(p(0.0, 0.0, 1.46), 0.055), (p(0.01, 0.0, 1.56), 0.055)], SIDES);
    ball(&mut mesh, "skin", p(0.02, 0.0, 1.615), p(0.095, 0.075, 0.115));
    ball(&mut mesh, "hair", p(-0.005, 0.0, 1.645), p(0.095, 0.082, 0.10));
    mesh
}

fn shoe(mesh: &mut Mesh, heel: DVec3) {
    ball(mesh, "rubber", heel + DVec3::new(0.07, 0.0, -0.045), DVec3::new(0.14, 0.048, 0.045));
}

/// An ellipsoid of these half axes.
fn ball(mesh: &mut Mesh, slot: &'static str, centre: DVec3, half: DVec3) {
    let frame = DAffine3 { matrix3: DMat3::from_diagonal(half), translation: centre };
    let profile =
        [[-1.0, 0.0], [-0.9, 0.436], [-0.6, 0.8], [-0.2, 0.98], [0.2, 0.98], [0.6, 0.8], [0.9, 0.436], [1.0, 0.0]];
    mesh.lathe(slot, frame, &profile, SIDES);
}
