//! A walker in motion: the phases of a cycle of two steps, each with the same vertices and faces.
//!
//! Of fewer faces than the walkers of the still street, and without normals, so that eight phases are not much larger than one of those. The
//! standing foot goes back at an even speed, straight from phase to phase: where the walker goes on by as much, it stays where it is.

use crate::File;
use crate::mesh::{along, circle};
use crate::obj::number;
use core::f64::consts::{PI, TAU};
use core::fmt::Write as _;
use etendue_core::maths::f64 as maths;
use glam::DVec3;

/// Phases of a cycle.
pub(super) const PHASES: usize = 8;
/// Half the way of a foot, m: a cycle goes on by four of these.
const REACH_M: f64 = 0.31;
/// How high a foot is lifted, m.
const LIFT_M: f64 = 0.11;
/// Length of thigh and of shank, m.
const BONE_M: f64 = 0.432;
/// Points round a limb, and round trunk and head.
const ROUND_LIMB: usize = 6;
const ROUND_BODY: usize = 9;

/// Phases a second of who walks at this speed (m/s) without sliding.
pub(super) fn rate_hz(speed_m_s: f64) -> f64 {
    PHASES as f64 * speed_m_s / (4.0 * REACH_M)
}

/// The files of all phases.
pub(super) fn files() -> Vec<File> {
    let file = |phase| {
        let text = walker(phase as f64 / PHASES as f64).obj();
        File::text(format!("street/meshes/walk-{phase}.obj"), text)
    };
    (0..PHASES).map(file).collect()
}

/// Vertices and faces by material.
#[derive(Default)]
struct WalkerMesh {
    vertices: Vec<DVec3>,
    faces: Vec<(&'static str, Vec<usize>)>,
}

impl WalkerMesh {
    /// A surface through closed rings of points, with both ends; counter-clockwise rings along their direction face outwards.
    fn loft(&mut self, slots: &[&'static str], rings: &[Vec<DVec3>]) {
        let (first, count) = (self.vertices.len(), rings[0].len());
        self.vertices.extend(rings.iter().flatten());
        let at = |ring: usize, point: usize| first + ring * count + point % count;
        for ring in 0..rings.len() - 1 {
            let slot = slots[ring.min(slots.len() - 1)];
            let cell = |point| vec![at(ring, point), at(ring, point + 1), at(ring + 1, point + 1), at(ring + 1, point)];
            self.faces.extend((0..count).map(|point| (slot, cell(point))));
        }
        let last = rings.len() - 1;
        self.faces.push((slots[0], (0..count).rev().map(|point| at(0, point)).collect()));
        self.faces.push((slots[slots.len() - 1], (0..count).map(|point| at(last, point)).collect()));
    }

    /// A tapered limb along (centre, radius).
    fn limb(&mut self, slots: &[&'static str], line: &[(DVec3, f64)]) {
        let ring = |i: usize| {
            let (before, after) = (line[i.saturating_sub(1)].0, line[(i + 1).min(line.len() - 1)].0);
            let (frame, radius) = (along(line[i].0, after - before), line[i].1);
            let point = |[c, s]: [f64; 2]| frame.transform_point3(DVec3::new(radius * c, radius * s, 0.0));
            circle(ROUND_LIMB).take(ROUND_LIMB).map(point).collect()
        };
        self.loft(slots, &(0..line.len()).map(ring).collect::<Vec<Vec<_>>>());
    }

    /// Upright ellipses: centre, half axes along x and y.
    fn trunk(&mut self, slots: &[&'static str], rings: &[(DVec3, [f64; 2])]) {
        let ring = |(centre, [x, y]): &(DVec3, [f64; 2])| {
            circle(ROUND_BODY).take(ROUND_BODY).map(|[c, s]| *centre + DVec3::new(x * c, y * s, 0.0)).collect()
        };
        self.loft(slots, &rings.iter().map(ring).collect::<Vec<Vec<_>>>());
    }

    fn obj(&self) -> String {
        let mut text = String::from("mtllib street.mtl\n");
        for vertex in &self.vertices {
            let [x, y, z] = vertex.to_array().map(number);
            let _ = writeln!(text, "v {x} {y} {z}");
        }
        for slot in ["trousers", "coat", "skin", "hair", "rubber"] {
            let _ = writeln!(text, "usemtl {slot}");
            for (_, face) in self.faces.iter().filter(|(own, _)| *own == slot) {
                text.push('f');
                face.iter().for_each(|vertex| _ = write!(text, " {}", vertex + 1));
                text.push('\n');
            }
        }
        text
    }
}

/// The walker at a part of the cycle, looking towards +x, the left foot ahead at 0.
fn walker(phase: f64) -> WalkerMesh {
    let (mut body, rise) = (WalkerMesh::default(), DVec3::Z * rise_m(phase));
    for (side, phase) in [(1.0, phase), (-1.0, phase + 0.5)] {
        leg(&mut body, side, phase - phase.floor(), rise);
    }
    let p = DVec3::new;
    let trunk = [
        (p(0.0, 0.0, 0.78), [0.125, 0.2]),
        (p(0.0, 0.0, 1.0), [0.105, 0.175]),
        (p(0.0, 0.0, 1.18), [0.112, 0.185]),
        (p(0.0, 0.0, 1.36), [0.12, 0.21]),
        (p(0.0, 0.0, 1.45), [0.09, 0.15]),
        (p(0.0, 0.0, 1.48), [0.05, 0.07]),
    ];
    body.trunk(&["coat"], &trunk.map(|(centre, half)| (centre + rise, half)));
    let head = [
        (p(0.0, 0.0, 1.46), [0.05, 0.05]),
        (p(0.01, 0.0, 1.52), [0.06, 0.055]),
        (p(0.02, 0.0, 1.56), [0.085, 0.065]),
        (p(0.02, 0.0, 1.63), [0.095, 0.076]),
        (p(0.01, 0.0, 1.69), [0.085, 0.07]),
        (p(0.0, 0.0, 1.73), [0.045, 0.04]),
    ];
    body.trunk(&["skin", "skin", "skin", "hair"], &head.map(|(centre, half)| (centre + rise, half)));
    body
}

/// By how much the body is higher over the standing foot than between two steps, m: six tenths of what a straight leg of 0.85 m asks for.
fn rise_m(phase: f64) -> f64 {
    const LEG_M: f64 = 0.85;
    let step = 2.0 * phase - (2.0 * phase).floor();
    let x = REACH_M * (1.0 - 2.0 * step);
    0.6 * ((LEG_M * LEG_M - x * x).sqrt() - (LEG_M * LEG_M - REACH_M * REACH_M).sqrt())
}

/// Where the ankle is at a part of the leg's own cycle: on the ground for its first half, then lifted ahead.
fn ankle(side: f64, phase: f64) -> DVec3 {
    let (x, lift) = match phase {
        stand if stand < 0.5 => (REACH_M * (1.0 - 4.0 * stand), 0.0),
        swing => {
            let part = 2.0 * swing - 1.0;
            (-REACH_M * maths::cos(PI * part), LIFT_M * maths::sin(PI * part))
        }
    };
    DVec3::new(x, 0.09 * side, 0.085 + lift)
}

/// A leg with its shoe, and the arm of the same side, which swings the other way.
fn leg(body: &mut WalkerMesh, side: f64, phase: f64, rise: DVec3) {
    let p = DVec3::new;
    let (hip, ankle) = (p(0.0, 0.095 * side, 0.875) + rise, ankle(side, phase));
    // The knee lies ahead of the line from hip to ankle, where two bones of one length meet.
    let line = ankle - hip;
    let bend = (BONE_M * BONE_M - 0.25 * line.length_squared()).max(0.0).sqrt();
    let knee = hip + line * 0.5 + p(-line.z, 0.0, line.x).normalize() * bend;
    body.limb(&["trousers"], &[(hip + DVec3::Z * 0.06, 0.085), (hip, 0.095), (knee, 0.065), (ankle, 0.048)]);
    let sole = |x: f64, half: f64, top: f64| -> Vec<DVec3> {
        [[half, 0.0], [half, top], [-half, top], [-half, 0.0]].map(|[y, z]| ankle + p(x, y, z - 0.085)).to_vec()
    };
    body.loft(&["rubber"], &[sole(-0.07, 0.035, 0.085), sole(0.07, 0.047, 0.085), sole(0.2, 0.035, 0.035)]);
    let swing = 0.26 * maths::cos(TAU * phase);
    let (shoulder, elbow) = (p(0.0, 0.20 * side, 1.40) + rise, p(-0.45 * swing - 0.02, 0.25 * side, 1.13) + rise);
    let hand = p(-1.1 * swing + 0.06, 0.24 * side, 0.9) + rise;
    let tip = hand + (hand - elbow).normalize() * 0.14;
    let arm = [(shoulder + DVec3::Z * 0.05, 0.03), (shoulder, 0.065), (elbow, 0.05), (hand, 0.04), (tip, 0.03)];
    body.limb(&["coat", "coat", "coat", "skin"], &arm);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn volume_m3(body: &WalkerMesh) -> f64 {
        let face_volume = |(_, face): &(_, Vec<usize>)| {
            let at = |i: usize| body.vertices[face[i]];
            (1..face.len() - 1).map(|i| at(0).dot(at(i).cross(at(i + 1))) / 6.0).sum::<f64>()
        };
        body.faces.iter().map(face_volume).sum()
    }

    /// Some 0.07 m³ of a grown person, limbs within the trunk counted twice; the phases differ by their knees only.
    #[test]
    fn all_phases_are_one_closed_body_that_faces_outwards() {
        let first = walker(0.0);
        for phase in 0..PHASES {
            let body = walker(phase as f64 / PHASES as f64);
            assert_eq!((body.faces.clone(), body.vertices.len()), (first.faces.clone(), first.vertices.len()));
            assert!((0.05..0.1).contains(&volume_m3(&body)), "{}", volume_m3(&body));
            let height = body.vertices.iter().map(|v| v.z).fold(f64::MAX, f64::min);
            assert!(height.abs() < 1e-9, "the standing foot is {height} m above the ground");
        }
    }

    /// A walker that goes on by a quarter of the cycle's way in a quarter of the cycle has left its standing foot where it was.
    #[test]
    fn the_standing_foot_does_not_slide() {
        for phase in [0.0, 0.125, 0.25] {
            let slid = ankle(1.0, phase + 0.125).x + 4.0 * REACH_M * 0.125 - ankle(1.0, phase).x;
            assert!(slid.abs() < 1e-12);
        }
    }
}
