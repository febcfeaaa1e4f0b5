//! A wheel: tyre, rim and seven spokes. It stands upright, its outer face towards +y, the axle at the origin.

use crate::mesh::{Mesh, along, circle};
use glam::DVec3;

const SEGMENTS: usize = 21;

/// A wheel of this radius, m.
#[must_use]
pub(super) fn mesh(radius: f64) -> Mesh {
    let mut mesh = Mesh::default();
    let frame = along(DVec3::ZERO, DVec3::Y);
    let radius_at_rim = radius * 0.70;
    let tyre = [
        [-0.10, radius_at_rim],
        [-0.105, radius * 0.93],
        [-0.075, radius],
        [0.075, radius],
        [0.105, radius * 0.93],
        [0.10, radius_at_rim],
    ];
    mesh.lathe("rubber", frame, &tyre, SEGMENTS);
    mesh.lathe(
        "alloy",
        frame,
        &[[0.10, radius_at_rim], [0.085, radius_at_rim * 0.93], [0.03, radius_at_rim * 0.91]],
        SEGMENTS,
    );
    let ring = |along: f64, r: f64| -> Vec<DVec3> {
        circle(SEGMENTS).map(|[c, s]| frame.transform_point3(DVec3::new(r * c, r * s, along))).collect()
    };
    let spokes = [
        ring(0.05, radius_at_rim * 0.92),
        ring(0.07, radius_at_rim * 0.60),
        ring(0.075, radius_at_rim * 0.22),
        ring(0.085, radius_at_rim * 0.18),
    ];
    mesh.loft(&spokes, |i, j| if i < 2 && j % 3 == 2 { "trim" } else { "alloy" });
    let mut hub = ring(0.085, radius_at_rim * 0.18);
    hub.pop();
    mesh.flat("alloy", &hub);
    let mut back = ring(-0.10, radius_at_rim);
    back.pop();
    back.reverse();
    mesh.flat("trim", &back);
    mesh
}
