//! The shape of a drop on glass: a spherical cap.
//!
//! Touching drops coalesce to one of their joint volume.
//!
//! Caps of one contact angle are similar, so volumes are proportional to the cubes of base radii. The new drop lies at the volume-weighted mean of
//! the two centres. It may touch others in turn; this is repeated until no two touch.

use core::f64::consts::{FRAC_PI_2, PI};

use etendue_core::maths::f64::{cbrt, sin_cos};
use glam::DVec2;

use super::course::Droplet;

/// A spherical cap of liquid: base radius a and contact angle θ, the angle within the liquid between glass and surface. The sphere has R = a/sin θ,
/// the cap the height h = R(1 − cos θ) and the volume π h (3a² + h²)/6.
///
/// A drop of water has this shape while gravity deforms it little: for a well below the capillary length √(γ/ρg) = 2.7 mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cap {
    base_mm: f64,
    sine: f64,
    cosine: f64,
}

impl Cap {
    /// Creates a cap from a base radius, mm, and a contact angle, rad, above 0 and below π.
    #[must_use]
    pub fn new(base_mm: f64, contact_angle_rad: f64) -> Self {
        let (sine, cosine) = sin_cos(contact_angle_rad);
        Self { base_mm, sine, cosine }
    }

    /// Radius of the wetted disc, mm.
    #[must_use]
    pub fn base_radius_mm(&self) -> f64 {
        self.base_mm
    }

    /// Radius of the sphere, mm.
    #[must_use]
    pub fn sphere_radius_mm(&self) -> f64 {
        self.base_mm / self.sine
    }

    /// Height above the glass, mm.
    #[must_use]
    pub fn height_mm(&self) -> f64 {
        self.sphere_radius_mm() * (1.0 - self.cosine)
    }

    /// Height of the sphere's centre above the glass, mm; below 0 for contact angles below 90°.
    #[must_use]
    pub fn centre_height_mm(&self) -> f64 {
        -self.sphere_radius_mm() * self.cosine
    }

    /// Volume, mm³ (µl).
    #[must_use]
    pub fn volume_mm3(&self) -> f64 {
        let (a, h) = (self.base_mm, self.height_mm());
        PI * h * (3.0 * a * a + h * h) / 6.0
    }

    /// Paraxial focal length R/(n − 1) of the cap as a plano-convex lens in air, mm.
    #[must_use]
    pub fn focal_length_mm(&self, index: f64) -> f64 {
        self.sphere_radius_mm() / (index - 1.0)
    }
}

/// Lateral extent of a cap over its base radius: 1 up to 90°; beyond that the sphere bulges over its base.
pub(super) fn reach_factor(contact_angle_rad: f64) -> f64 {
    if contact_angle_rad > FRAC_PI_2 { 1.0 / sin_cos(contact_angle_rad).0 } else { 1.0 }
}

/// Joins drops until no two are closer than the sum of their reaches (`reach_factor` × base radius). The order of the remaining drops is kept; of two
/// that join, the first in order remains.
pub(super) fn coalesce(drops: &mut Vec<Droplet>, reach_factor: f64) {
    while pass(drops, reach_factor) {}
}

/// The drop formed by two.
fn merged(a: Droplet, b: Droplet) -> Droplet {
    let cube = |d: Droplet| d.radius_mm * d.radius_mm * d.radius_mm;
    let (va, vb) = (cube(a), cube(b));
    let centre_mm = (a.centre_mm * va + b.centre_mm * vb) / (va + vb);
    Droplet { centre_mm, radius_mm: cbrt(va + vb) }
}

/// Visits all neighbours once; returns whether any two joined.
fn pass(drops: &mut Vec<Droplet>, reach_factor: f64) -> bool {
    let Some(bins) = DropBins::new(drops, reach_factor) else { return false };
    let mut gone = vec![false; drops.len()];
    let mut any = false;
    for i in 0..drops.len() {
        if gone[i] {
            continue;
        }
        for j in bins.after(i) {
            let touch_mm = (drops[i].radius_mm + drops[j].radius_mm) * reach_factor;
            if !gone[j] && drops[i].centre_mm.distance_squared(drops[j].centre_mm) < touch_mm * touch_mm {
                drops[i] = merged(drops[i], drops[j]);
                gone[j] = true;
                any = true;
            }
        }
    }
    let mut gone = gone.into_iter();
    drops.retain(|_| !gone.next().unwrap_or(false));
    any
}

/// Drops in square bins, sorted by bin, then by number.
struct DropBins {
    /// Bin and number of each drop, in order.
    sorted: Vec<((i64, i64), usize)>,
    /// The bin of each drop.
    bin: Vec<(i64, i64)>,
}

impl DropBins {
    /// `None` without drops. Bins are as wide as the reaches of the two largest drops, so that touching drops are in neighbouring bins.
    fn new(drops: &[Droplet], reach_factor: f64) -> Option<Self> {
        let maximum = drops.iter().map(|d| d.radius_mm).max_by(f64::total_cmp)?;
        let width_mm = 2.0 * maximum * reach_factor;
        let cell = |at: DVec2| ((at.x / width_mm).floor() as i64, (at.y / width_mm).floor() as i64);
        let bin: Vec<(i64, i64)> = drops.iter().map(|d| cell(d.centre_mm)).collect();
        let mut sorted: Vec<((i64, i64), usize)> = bin.iter().copied().zip(0..).collect();
        sorted.sort_unstable();
        Some(Self { sorted, bin })
    }

    /// Neighbours of a drop that come after it.
    fn after(&self, i: usize) -> impl Iterator<Item = usize> {
        let (x, y) = self.bin[i];
        (-1..=1).flat_map(move |dx| {
            let column = (x + dx, y - 1)..=(x + dx, y + 1);
            let start = self.sorted.partition_point(|(bin, _)| bin < column.start());
            let inside = self.sorted[start..].iter().take_while(move |(bin, _)| column.contains(bin));
            inside.map(|(_, j)| *j).filter(move |j| *j > i)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cap, DropsParameters, population::initial, tests::parameters};
    use super::*;

    /// Reference values of a drop of 1 mm at 60°: R 1.1547 mm, h 0.57735 mm, 1.0077 µl, and 3.467 mm of focal length in water of 1.333.
    #[test]
    fn a_drop_of_a_millimetre_at_60_degrees() {
        let cap = Cap::new(1.0, PI / 3.0);
        assert!((cap.sphere_radius_mm() - 1.154_700_538).abs() < 1e-9);
        assert!((cap.height_mm() - 0.577_350_269).abs() < 1e-9);
        assert!((cap.volume_mm3() - 1.007_666).abs() < 1e-6, "{}", cap.volume_mm3());
        assert!((cap.focal_length_mm(1.333) - 3.467_569).abs() < 1e-6, "{}", cap.focal_length_mm(1.333));
        // The circle through base edge and apex.
        let depth = cap.sphere_radius_mm() - cap.height_mm();
        assert!((depth + cap.centre_height_mm()).abs() < 1e-12);
        assert!((depth * depth + 1.0 - cap.sphere_radius_mm() * cap.sphere_radius_mm()).abs() < 1e-12);
    }

    #[test]
    fn a_half_sphere_and_what_lies_beyond() {
        let half = Cap::new(2.0, FRAC_PI_2);
        assert!((half.volume_mm3() - 16.0 * PI / 3.0).abs() < 1e-12 && (half.height_mm() - 2.0).abs() < 1e-12);
        // At 150° the sphere has twice the base radius.
        assert!((reach_factor(5.0 * PI / 6.0) - 2.0).abs() < 1e-12 && reach_factor(1.0) == 1.0);
        assert!(Cap::new(2.0, 5.0 * PI / 6.0).centre_height_mm() > 0.0);
    }

    #[test]
    fn volume_and_its_middle_are_conserved_and_none_touch() {
        for factor in [1.0, 2.0] {
            let p = DropsParameters { count: 3000, radius_mm: [0.3, 2.0], ..parameters() };
            let before = initial(&p);
            let mut after = before.clone();
            coalesce(&mut after, factor);
            assert!(after.len() < before.len() - 100, "{} of {}", after.len(), before.len());
            let volume = |d: &Droplet| Cap::new(d.radius_mm, 1.0).volume_mm3();
            let total = |drops: &[Droplet]| drops.iter().map(volume).sum::<f64>();
            // Sums of some thousand numbers, each joined by a cube root: a few ulp each.
            assert!((total(&after) / total(&before) - 1.0).abs() < 1e-12);
            let moment = |drops: &[Droplet]| drops.iter().map(|d| d.centre_mm * volume(d)).sum::<DVec2>();
            assert!((moment(&after) - moment(&before)).length() < 1e-9 * total(&before));
            for (i, a) in after.iter().enumerate() {
                for b in &after[i + 1..] {
                    assert!(a.centre_mm.distance(b.centre_mm) >= (a.radius_mm + b.radius_mm) * factor * (1.0 - 1e-12));
                }
            }
        }
    }

    #[test]
    fn two_equal_drops_meet_half_way() {
        let at = |x| Droplet { centre_mm: DVec2::new(x, 0.0), radius_mm: 1.0 };
        let mut apart = vec![at(0.0), at(2.1)];
        coalesce(&mut apart, 1.0);
        assert_eq!(apart, vec![at(0.0), at(2.1)]);
        let mut near = vec![at(0.0), at(1.9)];
        coalesce(&mut near, 1.0);
        assert!(near.len() == 1 && (near[0].centre_mm.x - 0.95).abs() < 1e-15);
        assert!((near[0].radius_mm - 1.259_921_049_894_873).abs() < 1e-14, "the cube root of 2");
    }
}
