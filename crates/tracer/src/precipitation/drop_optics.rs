//! A ray through a drop: a spheroid of water about an upright axis.
//!
//! At each interface one of both ways is drawn, by Fresnel's equations of one polarisation, which is drawn at the first and kept. (In a ball the plane
//! of incidence is the same at all; in a flattened drop it turns a little, and the polarisation with it, which is left out.) Water absorbs nothing
//! over millimetres.

use crate::materials::fresnel;
use glam::DVec3;

/// Passages through a drop that are followed; what is left comes out with the last.
const MOST: u32 = 12;

/// A ray that leaves a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Refracted {
    /// Where, from the drop's centre, m.
    pub(crate) place_m: DVec3,
    /// Where to; unit.
    pub(crate) direction: DVec3,
}

/// Follows a ray of unit `direction` that meets a spheroid of half-axes `half_m` (width, height) and index `n` at `place_m` from its centre.
/// `drawn` are numbers in [0, 1), one for each interface and one for the polarisation.
pub(crate) fn refracted(
    [wide_m, high_m]: [f64; 2],
    n: f64,
    (mut place_m, mut direction): (DVec3, DVec3),
    drawn: impl Fn(u32) -> f64,
) -> Refracted {
    let half_m = DVec3::new(wide_m, wide_m, high_m);
    let inverse2 = (half_m * half_m).recip();
    let plane = usize::from(drawn(0) < 0.5);
    for passage in 0..=MOST {
        // The normal against the ray.
        let out = (place_m * inverse2).normalize();
        let (normal, eta) = if passage == 0 { (out, n) } else { (-out, 1.0 / n) };
        let cos = (-direction.dot(normal)).max(0.0);
        let is_mirrored = drawn(1 + passage) < mirrored(cos, eta, plane);
        let through = bent(direction, normal, cos, eta);
        let leaves = (passage == 0) == is_mirrored || passage == MOST;
        direction = match through {
            Some(through) if !is_mirrored || (passage == MOST && leaves) => through,
            _ => (direction + normal * (2.0 * cos)).normalize(),
        };
        if leaves {
            return Refracted { place_m, direction };
        }
        let scaled = direction * inverse2;
        place_m += direction * (-2.0 * place_m.dot(scaled) / direction.dot(scaled));
    }
    Refracted { place_m, direction }
}

/// Reflectance of one polarisation at an interface into `eta` times the index.
fn mirrored(cos: f64, eta: f64, plane: usize) -> f64 {
    if (eta * eta - 1.0) + cos * cos <= 0.0 {
        return 1.0;
    }
    f64::from(fresnel::planes(cos as f32, eta as f32)[plane])
}

/// Snell's law; `None` beyond the critical angle.
fn bent(direction: DVec3, normal: DVec3, cos: f64, eta: f64) -> Option<DVec3> {
    let square = eta * eta - 1.0 + cos * cos;
    (square > 0.0).then(|| ((direction + normal * (cos - square.sqrt())) / eta).normalize())
}
