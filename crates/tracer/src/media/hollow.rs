//! Parts of a medium that are left out about a point, because they are modelled by themselves there.

use glam::DVec3;

/// Parts of an even medium, each of which begins at a distance of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Hollow {
    /// Where each part begins, m, rising, and what share of the medium it is.
    parts: Vec<(f64, f64)>,
}

impl Hollow {
    /// From where each part begins, m, and its share of the medium; all shares together are 1.
    #[must_use]
    pub fn new(mut parts: Vec<(f64, f64)>) -> Self {
        parts.sort_by(|a, b| a.0.total_cmp(&b.0));
        Self { parts }
    }

    /// What share of the medium is there at a distance, m.
    #[must_use]
    pub fn density(&self, distance_m: f64) -> f64 {
        self.parts.iter().take_while(|(from, _)| *from <= distance_m).map(|(_, share)| share).sum()
    }

    /// How far a part of a line leads through the medium, each part by its share; in lengths of the direction.
    #[must_use]
    pub fn way(&self, (origin, direction): (DVec3, DVec3), (from, to): (f64, f64)) -> f64 {
        let length2 = direction.length_squared();
        let middle = -origin.dot(direction) / length2;
        let aside2 = (origin + direction * middle).length_squared();
        let outside = |radius: f64| {
            let half = ((radius * radius - aside2) / length2).max(0.0).sqrt();
            let inside = ((middle + half).min(to) - (middle - half).max(from)).max(0.0);
            to - from - inside
        };
        self.parts.iter().filter(|(_, share)| *share > 0.0).map(|(radius, share)| share * outside(*radius)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_is_the_integral_of_the_density() {
        let hollow = Hollow::new(vec![(5.0, 0.3), (0.0, 0.5), (2.0, 0.2)]);
        let (origin, direction) = (DVec3::new(0.3, -1.0, 0.2), DVec3::new(1.0, 2.0, -0.5));
        let n = 200_000_u32;
        let (from, to) = (0.1, 6.0);
        let step = (to - from) / f64::from(n);
        let at = |i: u32| hollow.density((origin + direction * (from + (f64::from(i) + 0.5) * step)).length());
        let sum: f64 = (0..n).map(at).sum::<f64>() * step;
        // Three steps of the density, each met to half a step.
        assert!((hollow.way((origin, direction), (from, to)) - sum).abs() < 2.0 * step);
        assert_eq!((hollow.density(0.0), hollow.density(1e9)), (0.5, 1.0));
    }
}
