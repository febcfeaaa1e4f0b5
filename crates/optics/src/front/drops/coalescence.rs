//! Drops that touch become one of their joint volume.
//!
//! Caps of one contact angle are similar, so volumes add as cubes of base radii. The new drop lies at the mean of the two middles,
//! weighted by volume. It may touch others in turn, so this goes on until no two touch.

use super::droplet::Droplet;
use etendue_core::maths::f64::cbrt;
use glam::DVec2;

/// Joins drops until no two are nearer than their reaches (`reach_factor` × base radius) together. The order of those that remain is kept;
/// of two that join, the first in order remains.
pub(super) fn coalesce(drops: &mut Vec<Droplet>, reach_factor: f64) {
    while pass(drops, reach_factor) {}
}

/// The drop that two become.
fn joined(a: Droplet, b: Droplet) -> Droplet {
    let cube = |d: Droplet| d.radius_mm * d.radius_mm * d.radius_mm;
    let (va, vb) = (cube(a), cube(b));
    let centre_mm = (a.centre_mm * va + b.centre_mm * vb) / (va + vb);
    Droplet { centre_mm, radius_mm: cbrt(va + vb) }
}

/// Looks at all neighbours once; whether any two joined.
fn pass(drops: &mut Vec<Droplet>, reach_factor: f64) -> bool {
    let Some(bins) = Bins::of(drops, reach_factor) else { return false };
    let mut gone = vec![false; drops.len()];
    let mut any = false;
    for i in 0..drops.len() {
        if gone[i] {
            continue;
        }
        for j in bins.after(i) {
            let touch_mm = (drops[i].radius_mm + drops[j].radius_mm) * reach_factor;
            if !gone[j] && drops[i].centre_mm.distance_squared(drops[j].centre_mm) < touch_mm * touch_mm {
                drops[i] = joined(drops[i], drops[j]);
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
struct Bins {
    /// Bin and number of each drop, in order.
    sorted: Vec<((i64, i64), usize)>,
    /// The bin of each drop.
    bin: Vec<(i64, i64)>,
}

impl Bins {
    /// `None` without drops. Bins are as wide as the two greatest drops reach, so that those that touch are in neighbouring ones.
    fn of(drops: &[Droplet], reach_factor: f64) -> Option<Self> {
        let greatest = drops.iter().map(|d| d.radius_mm).max_by(f64::total_cmp)?;
        let width_mm = 2.0 * greatest * reach_factor;
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
    use super::super::population::first;
    use super::super::tests::parameters;
    use super::super::{Cap, DropsParameters};
    use super::*;

    #[test]
    fn volume_and_its_middle_are_conserved_and_none_touch() {
        for factor in [1.0, 2.0] {
            let p = DropsParameters { count: 3000, radius_mm: [0.3, 2.0], ..parameters() };
            let before = first(&p);
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
