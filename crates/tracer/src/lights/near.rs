//! A triangle or a parallelogram close to the receiving point.
//!
//! A point of a light sampled by area has the density r²/(A cos θ). Near by it grows from the closest part to the farthest by orders of magnitude:
//! almost all samples go to parts that contribute almost nothing, and the part that contributes is rarely sampled. Sampled by solid angle, the
//! density is 1/Ω everywhere.

use etendue_core::maths::f64::{atan2, sin_cos};
use glam::{DVec2, DVec3, Vec2, Vec3};

/// Minimum solid angle for sampling by solid angle, sr: below, by area (as pbrt-v4 does from 3e-4 on, in f32).
const MIN_SR: f64 = 1e-5;

/// Maximum distance of a near point, in radii of the light (from its middle to its farthest corner).
const NEAR_RADII: f32 = 2.0;

/// Four roundings of f32.
const EARLY_HIT_ERROR: f32 = 4.0 * 0.5 * f32::EPSILON;

/// A flat light: a corner and the two edges from it. If `doubled`, the same triangle lies again beyond the side that the edges leave open.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlatLight {
    pub(super) corner: Vec3,
    pub(super) edges: [Vec3; 2],
    pub(super) doubled: bool,
}

impl FlatLight {
    /// A point, in fractions of the edges.
    pub(super) fn at(&self, fractions: Vec2) -> Vec3 {
        self.corner + self.edges[0] * fractions.x + self.edges[1] * fractions.y
    }

    /// Distance before a point of the light at which the accelerator may hit it, along the ray to it: some roundings of f32 of its length.
    /// For a needle the distance is larger by the ratio of its length to its width, as its barycentric coordinates are as uncertain.
    pub(super) fn early_m(&self) -> f32 {
        let [along, across] = self.edges;
        let length2 = along.length_squared().max(across.length_squared());
        EARLY_HIT_ERROR * length2 * length2.sqrt() / along.cross(across).length()
    }

    /// The corners; of a triangle the last one twice.
    pub(super) fn corners(&self) -> [Vec3; 4] {
        let far = if self.doubled { Vec2::ONE } else { Vec2::Y };
        [Vec2::ZERO, Vec2::X, Vec2::Y, far].map(|fractions| self.at(fractions))
    }
}

/// Region in which a point is near to a flat light.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearRegion {
    centre: Vec3,
    radius2: f32,
}

impl NearRegion {
    pub(super) fn new(flat: &FlatLight) -> Self {
        let centre = flat.at(Vec2::splat(if flat.doubled { 0.5 } else { 1.0 / 3.0 }));
        let extent2 = flat.corners().map(|corner| corner.distance_squared(centre)).into_iter().fold(0.0, f32::max);
        Self { centre, radius2: NEAR_RADII * NEAR_RADII * extent2 }
    }

    pub(super) fn holds(&self, from: Vec3) -> bool {
        from.distance_squared(self.centre) < self.radius2
    }
}

/// A flat light as seen from a point near by.
#[derive(Clone, Copy, Debug)]
pub(super) struct NearView {
    /// The corner relative to the point, and the edges.
    corner: DVec3,
    edges: [DVec3; 2],
    triangle: SphericalTriangle,
    far: Option<SphericalTriangle>,
    solid_angle_sr: f64,
    /// 1/Ω.
    pub(super) per_sr: f32,
}

impl NearView {
    /// `None` if it covers too few directions, for example edge-on.
    pub(super) fn new(flat: &FlatLight, from: Vec3) -> Option<Self> {
        let corner = flat.corner.as_dvec3() - from.as_dvec3();
        let edges = flat.edges.map(|edge| edge.as_dvec3());
        let [along, across] = edges.map(|edge| corner + edge);
        let triangle = SphericalTriangle::new([corner, along, across]);
        let far = flat.doubled.then(|| SphericalTriangle::new([along + edges[1], across, along]));
        let solid_angle_sr = triangle.solid_angle_sr() + far.map_or(0.0, |far| far.solid_angle_sr());
        let per_sr = (1.0 / solid_angle_sr) as f32;
        (solid_angle_sr > MIN_SR).then_some(Self { corner, edges, triangle, far, solid_angle_sr, per_sr })
    }

    /// A point of the light, in fractions of its edges; `None` if rounding leaves no number.
    pub(super) fn place(&self, u: Vec2) -> Option<Vec2> {
        let u = u.as_dvec2();
        let fraction = self.triangle.solid_angle_sr() / self.solid_angle_sr;
        let direction = match &self.far {
            Some(far) if u.x >= fraction => far.sample(DVec2::new((u.x - fraction) / (1.0 - fraction), u.y)),
            _ => self.triangle.sample(DVec2::new((u.x / fraction).min(1.0), u.y)),
        };
        let place = self.plane_coordinates(direction);
        let place = if self.far.is_some() { place } else { place / place.element_sum().max(1.0) };
        place.is_finite().then(|| place.as_vec2())
    }

    /// Intersection of a direction with the light's plane, in fractions of the edges, clamped to the light.
    fn plane_coordinates(&self, direction: DVec3) -> DVec2 {
        let [along, across] = self.edges;
        let normal = along.cross(across);
        let aside = direction * (normal.dot(self.corner) / normal.dot(direction)) - self.corner;
        let place = DVec2::new(aside.cross(across).dot(normal), along.cross(aside).dot(normal));
        (place / normal.length_squared()).clamp(DVec2::ZERO, DVec2::ONE)
    }
}

// Spherical triangles: the directions that a flat triangle covers about a point.
//
// The solid angle Ω is that of Van Oosterom & Strackee 1983, tan(Ω/2) = |a·(b×c)| / (1 + a·b + b·c + c·a) for the unit directions a, b, c
// of the corners. Directions are sampled uniformly after Arvo 1995 ("Stratified sampling of spherical triangles"), in f64: the triangles
// may be needles, or cover nearly half of all directions.

/// A triangle as seen from a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct SphericalTriangle {
    /// Unit directions of the corners.
    corners: [DVec3; 3],
    /// a·(b×c), 0 or more.
    volume: f64,
    solid_angle_sr: f64,
}

impl SphericalTriangle {
    /// From corners relative to the point; NaN if the point lies at one of them.
    pub(super) fn new(corners: [DVec3; 3]) -> Self {
        let [a, b, c] = corners;
        let lengths = corners.map(DVec3::length);
        // By the edges: the product of the corners themselves has few digits if the triangle is small or far.
        let volume = a.dot((b - a).cross(c - a)).abs() / (lengths[0] * lengths[1] * lengths[2]);
        let corners = [a / lengths[0], b / lengths[1], c / lengths[2]];
        let [a, b, c] = corners;
        let solid_angle_sr = 2.0 * atan2(volume, 1.0 + a.dot(b) + b.dot(c) + c.dot(a));
        Self { corners, volume, solid_angle_sr }
    }

    pub(super) fn solid_angle_sr(&self) -> f64 {
        self.solid_angle_sr
    }

    /// A unit direction, uniform by solid angle; NaN if the triangle has no area.
    pub(super) fn sample(&self, u: DVec2) -> DVec3 {
        let [a, b, c] = self.corners;
        let cos_side = a.dot(b);
        // The angle at a, between the planes of its sides.
        let (ab, ac) = (a.cross(b), a.cross(c));
        let per_sides = 1.0 / (ab.length() * ac.length());
        let (sin_a, cos_a) = (self.volume * per_sides, ab.dot(ac) * per_sides);
        // The corner c' on the side ac that cuts off the fraction u.x of the solid angle.
        let (sin, cos) = sin_cos(u.x * self.solid_angle_sr);
        let (s, t) = (sin * cos_a - cos * sin_a, cos * cos_a + sin * sin_a);
        let (p, q) = (t - cos_a, s + sin_a * cos_side);
        let cos_cut = ((q * t - p * s) * cos_a - q) / ((q * s + p * t) * sin_a);
        let cut = towards(a, c, cos_cut.clamp(a.dot(c), 1.0));
        let cos_along = 1.0 - u.y * (1.0 - cut.dot(b));
        towards(b, cut, cos_along)
    }
}

/// The unit direction at an angle of this cosine from `from` towards `to`.
fn towards(from: DVec3, to: DVec3, cos: f64) -> DVec3 {
    let aside = (to - from * from.dot(to)).normalize_or_zero();
    from * cos + aside * (1.0 - cos * cos).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue_stats::chi_square;

    /// Cells along each edge.
    const CELLS: usize = 6;
    /// Samples along each dimension.
    const SAMPLES: usize = 300;

    fn flat(corner: Vec3, along: Vec3, across: Vec3, doubled: bool) -> FlatLight {
        FlatLight { corner, edges: [along, across], doubled }
    }

    /// Squares, needles and slanted ones, close by, grazing and far.
    fn flats() -> Vec<FlatLight> {
        let strip = Vec3::new(0.0, 2.4, 0.0);
        let mut all = Vec::new();
        for doubled in [true, false] {
            all.push(flat(Vec3::new(-0.5, -0.5, 1.0), Vec3::X, Vec3::Y, doubled));
            all.push(flat(Vec3::new(-0.5, -0.7, 1e-3), Vec3::X, Vec3::Y, doubled));
            all.push(flat(Vec3::new(0.03, -1.1, 0.02), Vec3::new(0.01, 0.0, 0.0), strip, doubled));
            all.push(flat(Vec3::new(2.0, 0.3, 0.05), Vec3::new(1.0, 0.2, 0.02), Vec3::new(0.4, 1.0, -0.01), doubled));
            all.push(flat(Vec3::new(0.1, 0.2, 9.0), Vec3::new(0.1, 0.0, 0.03), Vec3::new(0.02, 0.1, 0.0), doubled));
        }
        all
    }

    /// Solid angle of the part between fractions of the edges, cut along the light's own diagonal.
    fn part_solid_angle_sr(flat: &FlatLight, [i, j]: [usize; 2]) -> f64 {
        let at = |i: usize, j: usize| flat.at(Vec2::new(i as f32, j as f32) / CELLS as f32).as_dvec3();
        let solid_angle_sr = |corners: [DVec3; 3]| SphericalTriangle::new(corners).solid_angle_sr();
        let within = flat.doubled || i + j + 1 < CELLS;
        let near =
            if flat.doubled || i + j < CELLS { solid_angle_sr([at(i, j), at(i + 1, j), at(i, j + 1)]) } else { 0.0 };
        near + if within { solid_angle_sr([at(i + 1, j + 1), at(i, j + 1), at(i + 1, j)]) } else { 0.0 }
    }

    #[test]
    fn points_are_sampled_by_solid_angle() {
        for flat in flats() {
            let near = NearView::new(&flat, Vec3::ZERO).expect("it fills some of the directions");
            let mut counts = vec![0; CELLS * CELLS];
            for k in 0..SAMPLES * SAMPLES {
                // A lattice of rank one: uniform, but not aligned with any cell.
                let u = Vec2::new(
                    ((k as f64 * 0.754_877_666_246_69) % 1.0) as f32,
                    ((k as f64 * 0.569_840_290_998_05) % 1.0) as f32,
                );
                let place = near.place(u).expect("a point") * CELLS as f32;
                counts[(place.x as usize).min(CELLS - 1) * CELLS + (place.y as usize).min(CELLS - 1)] += 1;
            }
            let parts: Vec<f64> =
                (0..CELLS * CELLS).map(|k| part_solid_angle_sr(&flat, [k / CELLS, k % CELLS])).collect();
            let total: f64 = parts.iter().sum();
            assert!((total / near.solid_angle_sr - 1.0).abs() < 1e-5, "{flat:?}: {total} {}", near.solid_angle_sr);
            assert!((f64::from(near.per_sr) * total - 1.0).abs() < 1e-5);
            let expected: Vec<f64> = parts.iter().map(|part| part / total * (SAMPLES * SAMPLES) as f64).collect();
            let test = chi_square::goodness_of_fit(&counts, &expected).expect("cells");
            assert!(test.p > 1e-3, "{flat:?}: {test:?}");
        }
    }

    #[test]
    fn what_is_seen_edge_on_or_from_its_corner_is_not_sampled_by_solid_angle() {
        let square = flat(Vec3::new(1.0, 0.0, 0.0), Vec3::X, Vec3::Y, true);
        assert!(NearView::new(&square, Vec3::ZERO).is_none());
        assert!(NearView::new(&square, Vec3::X).is_none());
    }

    #[test]
    fn the_solid_angle_of_a_cubes_side_is_a_sixth_of_all() {
        let side = flat(Vec3::new(-1.0, -1.0, 1.0), Vec3::X * 2.0, Vec3::Y * 2.0, true);
        let near = NearView::new(&side, Vec3::ZERO).expect("a side");
        assert!((near.solid_angle_sr - 4.0 * core::f64::consts::PI / 6.0).abs() < 1e-12);
    }
}
