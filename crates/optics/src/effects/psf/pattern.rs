//! The diffraction pattern of a pupil: |∫ P(u) exp(2πi (W(u)/λ − u·x/2λN)) du|².
//!
//! u is a point of the pupil in units of its radius, x a point of the image, N the working f-number and W the wavefront error. A ray through u lands
//! at x = 2N ∂W/∂u, in the axes of the erect image. The pupil is sampled on a square lattice; each cell holds its open fraction. The pattern then has
//! a step of λN/Q and extends to half the number of lattice cells times that step. Q is at least 2, so the sum of the pattern equals its integral.
//!
//! The aperture outline is in units of the radius that the f-number defines.
//!
//! It is a circle, or one arc per blade: with the curvature c the radius of the arcs is the corner radius over c, so 0 is a polygon and 1 the circle.
//! The area always equals that of the circle of the f-number, so the amount of light is the same. A round central obstruction (mirror lens) is
//! removed from it.
//!
//! Zernike circle polynomials, normalised to a root mean square of one over the unit disc.
//!
//! Z = √(n + 1) R_n⁰ for m = 0, else √(2(n + 1)) R_n^|m| times cos mθ (m > 0) or sin |m|θ (m < 0), with the angle from x towards y. Single indices
//! follow Noll (1976), from 1, or ANSI Z80.28 / OSA, from 0.

use core::f64::consts::{PI, TAU};

use etendue_core::maths::f64::{asin, atan2, sin_cos};
use glam::DVec2;

use crate::effects::fourier::{ComplexGrid, TransformPlan};

/// Lattice cells along a side.
pub(super) const CELLS: usize = 1024;
/// Subdivisions of a cell along a side, used to estimate its open fraction.
const PARTS: usize = 4;

/// The sampled pupil.
#[derive(Clone, Debug)]
pub(super) struct Pupil {
    /// Oversampling Q.
    fineness: f64,
    /// Rows that are not all dark, and the number of cells on one side of the centre.
    half: usize,
    /// Open fractions of the cells about the centre, row by row.
    open: Vec<f64>,
}

/// Intensities over the lattice about the centre; they sum to one.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    values: Vec<f64>,
}

impl Pupil {
    pub(super) fn new(outline: &ApertureOutline, fineness: f64) -> Self {
        let half = ((outline.radius() * 0.5 * CELLS as f64 / fineness).ceil() as usize + 1).min(CELLS / 2);
        let step = Self::step(fineness);
        let open = |i: usize| open(outline, Self::cell(i, half, step), step);
        Self { fineness, half, open: (0..4 * half * half).map(open).collect() }
    }

    /// Side of a cell in units of the pupil's radius.
    fn step(fineness: f64) -> f64 {
        2.0 * fineness / CELLS as f64
    }

    fn cell(i: usize, half: usize, step: f64) -> DVec2 {
        let (x, y) = (i % (2 * half), i / (2 * half));
        (DVec2::new(x as f64, y as f64) - half as f64 + 0.5) * step
    }

    /// Evaluates `f` at every open cell (a wavefront); 0 elsewhere.
    pub(super) fn map(&self, f: impl Fn(DVec2) -> f64) -> Vec<f64> {
        let step = Self::step(self.fineness);
        let value = |i: usize| if self.open[i] > 0.0 { f(Self::cell(i, self.half, step)) } else { 0.0 };
        (0..self.open.len()).map(value).collect()
    }

    /// The pattern of a wavefront, in waves at each cell.
    pub(super) fn pattern(&self, waves: Option<&[f64]>) -> Pattern {
        let plan = TransformPlan::new(CELLS, CELLS);
        let mut grid = ComplexGrid::zeros(CELLS, CELLS);
        let side = 2 * self.half;
        for y in 0..side {
            for x in 0..side {
                let (sine, cosine) = waves.map_or((0.0, 1.0), |w| sin_cos(TAU * w[y * side + x]));
                let open = self.open[y * side + x];
                grid.re_mut(y)[x] = open * cosine;
                grid.im_mut(y)[x] = open * sine;
            }
        }
        plan.forward(&mut grid, 0..side);
        let row = |y: usize| grid.re(y).iter().zip(grid.im(y)).map(|(re, im)| re * re + im * im).collect::<Vec<_>>();
        let values: Vec<f64> = (0..CELLS).flat_map(row).collect();
        let sum: f64 = values.iter().sum();
        Pattern { values: values.iter().map(|v| v / sum).collect() }
    }
}

fn open(outline: &ApertureOutline, centre: DVec2, step: f64) -> f64 {
    let place = |i: usize| (i as f64 + 0.5) / PARTS as f64 - 0.5;
    let part = |i: usize| centre + DVec2::new(place(i % PARTS), place(i / PARTS)) * step;
    (0..PARTS * PARTS).filter(|i| outline.passes(part(*i))).count() as f64 / (PARTS * PARTS) as f64
}

impl Pattern {
    /// Positions, in steps of λN/Q, and fractions of the light.
    #[cfg(test)]
    pub(super) fn points(&self) -> impl Iterator<Item = (DVec2, f64)> {
        self.points_within(CELLS / 2)
    }

    /// Positions at most `steps` from the centre along rows and columns.
    pub(super) fn points_within(&self, steps: usize) -> impl Iterator<Item = (DVec2, f64)> {
        let near = steps.min(CELLS / 2) as isize;
        let range = move || -near..(near + 1).min(CELLS as isize / 2);
        let index = |i: isize| i.rem_euclid(CELLS as isize) as usize;
        range().flat_map(move |y| {
            let row = &self.values[index(y) * CELLS..][..CELLS];
            range().map(move |x| (DVec2::new(x as f64, y as f64), row[index(x)]))
        })
    }
}

/// The outline of an aperture.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ApertureOutline {
    edges: Vec<Edge>,
    /// Radius of the corners or of the circle.
    radius: f64,
    obstruction: f64,
}

/// The arc of a blade: points within `radius` of `centre`, or below `distance` along `normal` where it is straight.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Edge {
    normal: DVec2,
    distance: f64,
    curve: Option<(DVec2, f64)>,
}

impl ApertureOutline {
    /// `blades` (0 for a circle) of a curvature, the first corner at `rotation_rad` from x towards y.
    pub(super) fn new(blades: u32, curvature: f64, rotation_rad: f64, obstruction: f64) -> Self {
        if blades == 0 {
            return Self { edges: Vec::new(), radius: 1.0, obstruction };
        }
        let half = PI / f64::from(blades);
        let (sine, cosine) = sin_cos(half);
        // Corners at radius one: triangles, and the segments between chord and arc.
        let segment = if curvature > 0.0 {
            let arc = 1.0 / curvature;
            arc * arc * asin((sine / arc).min(1.0)) - sine * (arc * arc - sine * sine).sqrt()
        } else {
            0.0
        };
        let radius = (PI / (f64::from(blades) * (sine * cosine + segment))).sqrt();
        let edge = |i: u32| {
            let (y, x) = sin_cos(rotation_rad + (2.0 * f64::from(i) + 1.0) * half);
            let (normal, distance, chord) = (DVec2::new(x, y), radius * cosine, radius * sine);
            let curve = (curvature > 0.0).then(|| {
                let arc = radius / curvature;
                (normal * (distance - (arc * arc - chord * chord).sqrt()), arc)
            });
            Edge { normal, distance, curve }
        };
        Self { edges: (0..blades).map(edge).collect(), radius, obstruction }
    }

    /// The radius of the smallest enclosing circle about the centre.
    pub(super) fn radius(&self) -> f64 {
        self.radius
    }

    /// True if light passes at a point.
    pub(super) fn passes(&self, point: DVec2) -> bool {
        let r2 = point.length_squared();
        let within = |edge: &Edge| match edge.curve {
            Some((centre, radius)) => (point - centre).length_squared() <= radius * radius,
            None => point.dot(edge.normal) <= edge.distance,
        };
        r2 <= self.radius * self.radius && r2 >= self.obstruction * self.obstruction && self.edges.iter().all(within)
    }
}

/// The largest radial order.
const MAX_ORDER: u32 = 12;

/// A Zernike polynomial.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zernike {
    n: u32,
    m: i32,
}

impl Zernike {
    /// The polynomial of a Noll index (from 1); `None` beyond order 12.
    #[must_use]
    pub fn noll(index: u32) -> Option<Self> {
        let n = (0..=MAX_ORDER).find(|n| index >= 1 && index <= (n + 1) * (n + 2) / 2)?;
        let k = index - n * (n + 1) / 2 - 1;
        let m = if n.is_multiple_of(2) { 2 * k.div_ceil(2) } else { 2 * (k / 2) + 1 };
        let m = m.cast_signed();
        Some(Self { n, m: if index.is_multiple_of(2) { m } else { -m } })
    }

    /// The polynomial of an OSA/ANSI index (from 0); `None` beyond order 12.
    #[must_use]
    pub fn osa(index: u32) -> Option<Self> {
        let n = (0..=MAX_ORDER).find(|n| index < (n + 1) * (n + 2) / 2)?;
        Some(Self { n, m: (2 * index).cast_signed() - (n * (n + 2)).cast_signed() })
    }

    /// Radial and azimuthal orders.
    #[must_use]
    pub fn radial_and_azimuthal_order(&self) -> (u32, i32) {
        (self.n, self.m)
    }

    /// The polynomial at a point of the pupil; it is also evaluated beyond the unit disc.
    #[must_use]
    pub fn at(&self, point: DVec2) -> f64 {
        let m = self.m.unsigned_abs();
        let norm = f64::from(if m == 0 { self.n + 1 } else { 2 * (self.n + 1) }).sqrt();
        let (sine, cosine) = sin_cos(f64::from(m) * atan2(point.y, point.x));
        norm * self.radial(point.length()) * if self.m < 0 { sine } else { cosine }
    }

    /// R_n^m = Σ (−1)^k (n − k)! / (k! ((n + m)/2 − k)! ((n − m)/2 − k)!) r^(n − 2k).
    fn radial(&self, r: f64) -> f64 {
        let m = self.m.unsigned_abs();
        let term = |k: u32| {
            let below = factorial(k) * factorial((self.n + m) / 2 - k) * factorial((self.n - m) / 2 - k);
            let sign = if k.is_multiple_of(2) { 1.0 } else { -1.0 };
            sign * factorial(self.n - k) / below * (0..self.n - 2 * k).map(|_| r).product::<f64>()
        };
        (0..=(self.n - m) / 2).map(term).sum()
    }
}

fn factorial(n: u32) -> f64 {
    (1..=n).map(f64::from).product()
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use etendue_core::maths::f64::acos;

    use super::*;

    fn circle(fineness: f64) -> Pattern {
        Pupil::new(&ApertureOutline::new(0, 0.0, 0.0, 0.0), fineness).pattern(None)
    }

    /// Fraction of the light within a radius, in units of λN.
    fn within(pattern: &Pattern, fineness: f64, radius: f64) -> f64 {
        pattern.points().filter(|(p, _)| p.length() <= radius * fineness).map(|(_, v)| v).sum()
    }

    #[test]
    fn a_circle_makes_airy_s_pattern() {
        let pattern = circle(16.0);
        // The first zero: 1.2197 λN (Airy 1835). Steps of 1/16 λN.
        let along = |i: usize| pattern.values[i];
        let zero = (1..32).min_by(|a, b| along(*a).total_cmp(&along(*b))).expect("some");
        assert!((zero as f64 / 16.0 - 1.2197).abs() < 0.5 / 16.0, "{zero}");
        // Within the first zero lies 83.8 %, within the second 91.0 % (Rayleigh 1881), of all light: 2/(π² 32) = 0.6 % lies beyond the lattice's 32
        // λN, and the fractions of the border cells take half as much from just inside its end.
        for (radius, fraction) in [(1.2197, 0.838), (2.233, 0.910)] {
            let actual = within(&pattern, 16.0, radius);
            assert!((actual - fraction).abs() < 0.01, "{radius}: {actual} for {fraction}");
        }
    }

    #[test]
    fn its_transform_is_the_modulation_of_a_circle() {
        let pattern = circle(4.0);
        for v in [0.1f64, 0.3, 0.5, 0.8] {
            let wave = |(p, fraction): (DVec2, f64)| fraction * sin_cos(TAU * v * p.x / 4.0).1;
            let actual: f64 = pattern.points().map(wave).sum();
            let expected = 2.0 / PI * (acos(v) - v * (1.0 - v * v).sqrt());
            // 2/(π² 128) = 0.16 % of the light lies beyond the lattice, and as much is taken from just inside its end.
            assert!((actual - expected).abs() < 3.2e-3, "{v}: {actual} for {expected}");
        }
    }

    #[test]
    fn a_small_error_dims_the_middle_as_marechal_says() {
        let pupil = Pupil::new(&ApertureOutline::new(0, 0.0, 0.0, 0.0), 4.0);
        let clean = pupil.pattern(None).values[0];
        for (index, rms) in [(4, 0.03), (6, 0.05), (8, 0.04), (11, 0.05)] {
            let zernike = super::super::Zernike::noll(index).expect("known");
            let waves = pupil.map(|u| rms * zernike.at(u));
            let strehl = pupil.pattern(Some(&waves)).values[0] / clean;
            let phase = TAU * rms;
            // The next order of the logarithm: here below (2πσ)⁴/4.
            assert!(
                (strehl - etendue_core::maths::f64::exp(-phase * phase)).abs()
                    < (phase * phase) * (phase * phase) / 4.0 + 1e-3,
                "{index}"
            );
        }
    }

    #[test]
    fn far_out_of_focus_it_is_the_geometric_disc() {
        let fineness = 4.0;
        let pupil = Pupil::new(&ApertureOutline::new(0, 0.0, 0.0, 0.0), fineness);
        // W = a √3 (2r² − 1) = 20 waves of r²: the disc's radius is 2N dW/dr = 80 λN.
        let zernike = super::super::Zernike::noll(4).expect("known");
        let waves = pupil.map(|u| 10.0 / 3f64.sqrt() * zernike.at(u));
        let pattern = pupil.pattern(Some(&waves));
        for fraction in [0.3, 0.6, 0.9] {
            let actual = within(&pattern, fineness, fraction * 80.0);
            // Fresnel's fringe at the border of the disc is 37 % brighter over about 1/√40 of the radius.
            assert!((actual - fraction * fraction).abs() < 0.05, "{fraction}: {actual}");
        }
        assert!(within(&pattern, fineness, 88.0) > 0.98);
    }

    #[test]
    fn blades_make_as_many_spikes_or_twice_as_many() {
        for (blades, spikes) in [(5, 10), (6, 6), (7, 14), (8, 8)] {
            let pattern = Pupil::new(&ApertureOutline::new(blades, 0.0, 0.0, 0.0), 2.0).pattern(None);
            let bins = 840;
            let mut light = vec![0.0; bins];
            for (p, v) in pattern.points().filter(|(p, _)| (60.0..200.0).contains(&p.length())) {
                let turn = etendue_core::maths::f64::atan2(p.y, p.x) / TAU + 1.0;
                light[(turn * bins as f64) as usize % bins] += v;
            }
            let wide: Vec<f64> = (0..bins).map(|i| (0..7).map(|k| light[(i + k) % bins]).sum()).collect();
            let threshold = 4.0 * wide.iter().sum::<f64>() / bins as f64;
            let rises = (0..bins).filter(|i| wide[*i] < threshold && wide[(i + 1) % bins] >= threshold).count();
            assert_eq!(rises, spikes, "{blades} blades");
        }
    }

    #[test]
    fn every_outline_has_the_area_of_the_circle() {
        let cells = 1000;
        for (blades, curvature) in [(0, 0.0), (3, 0.0), (5, 0.4), (6, 0.0), (7, 0.9), (8, 1.0)] {
            let outline = ApertureOutline::new(blades, curvature, 0.3, 0.0);
            let side = 2.0 * outline.radius() / f64::from(cells);
            let centre = |i: i32| (f64::from(i) + 0.5) * side - outline.radius();
            let inside = |i: i32| (0..cells).filter(|j| outline.passes(DVec2::new(centre(i), centre(*j)))).count();
            let area = (0..cells).map(inside).sum::<usize>() as f64 * side * side;
            // Border cells: about 1e-4 of the area.
            assert!((area / PI - 1.0).abs() < 3e-4, "{blades} {curvature}: {area}");
        }
    }

    #[test]
    fn corners_lie_where_they_are_turned_to() {
        let outline = ApertureOutline::new(6, 0.0, 0.2, 0.3);
        let at = |angle: f64, r: f64| {
            let (s, c) = sin_cos(angle);
            outline.passes(DVec2::new(c, s) * r)
        };
        let flat = outline.radius() * 3f64.sqrt() / 2.0;
        assert!(at(0.2, 0.999 * outline.radius()) && !at(0.2, 1.001 * outline.radius()));
        assert!(at(0.2 + PI / 6.0, 0.999 * flat) && !at(0.2 + PI / 6.0, 1.001 * flat));
        assert!(!at(1.0, 0.299) && at(1.0, 0.301));
    }

    #[test]
    fn indices_are_those_of_the_tables() {
        // Noll (1976), table I; ANSI Z80.28.
        let noll =
            [(1, 0, 0), (2, 1, 1), (3, 1, -1), (4, 2, 0), (5, 2, -2), (6, 2, 2), (7, 3, -1), (8, 3, 1), (11, 4, 0)];
        for (j, n, m) in noll {
            assert_eq!(Zernike::noll(j).expect("known").radial_and_azimuthal_order(), (n, m), "Noll {j}");
        }
        let osa =
            [(0, 0, 0), (1, 1, -1), (2, 1, 1), (3, 2, -2), (4, 2, 0), (5, 2, 2), (7, 3, -1), (8, 3, 1), (12, 4, 0)];
        for (j, n, m) in osa {
            assert_eq!(Zernike::osa(j).expect("known").radial_and_azimuthal_order(), (n, m), "OSA {j}");
        }
        assert!(Zernike::noll(0).is_none() && Zernike::noll(92).is_none() && Zernike::osa(91).is_none());
    }

    #[test]
    fn they_are_orthogonal_with_root_mean_square_one() {
        let all: Vec<_> = (1..=28).filter_map(Zernike::noll).collect();
        let (rings, angles) = (400, 64);
        let mut sums = vec![0.0; all.len() * all.len()];
        for i in 0..rings * angles {
            let r = ((f64::from(i / angles) + 0.5) / f64::from(rings)).sqrt();
            let (s, c) = sin_cos(core::f64::consts::TAU * f64::from(i % angles) / f64::from(angles));
            let values: Vec<f64> = all.iter().map(|z| z.at(DVec2::new(c, s) * r)).collect();
            for (a, row) in values.iter().zip(sums.chunks_mut(all.len())) {
                values.iter().zip(row).for_each(|(b, sum)| *sum += a * b / f64::from(rings * angles));
            }
        }
        for (i, sum) in sums.iter().enumerate() {
            let expected = f64::from(u8::from(i % all.len() == i / all.len()));
            // Midpoint rule with 400 rings: second order, times the slopes of polynomials of the sixth order.
            assert!((sum - expected).abs() < 1e-3, "{i}: {sum}");
        }
    }
}
