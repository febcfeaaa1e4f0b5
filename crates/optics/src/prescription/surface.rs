//! A surface of a lens: its shape, and its intersection with a ray.
//!
//! z runs from the scene to the sensor, r² = x² + y² from the vertex. With curvature c = 1/R and conic constant k the sag is z = c r²/(1 + √(1 − (1 +
//! k) c² r²)) + Σ αᵢ r²ⁱ, i = 1 … 10; k = 0 is a sphere, −1 a paraboloid, below −1 a hyperboloid, above 0 an oblate ellipsoid.
//!
//! **Choice between two intersections.** A sequential ray crosses from the scene's side of a surface to the sensor's side, or back. The sign of
//! direction · normal is therefore known in advance and selects the root, also for rays so oblique that they run backwards along the axis. Only the
//! sheet at the vertex counts, up to its equator.
//!
//! **Mirrors** are unfolded: z is reversed at every mirror, so that light always travels towards +z and all thicknesses are positive. The shape of a
//! mirror is described in the space before it.

use etendue_spectra::glass::Dispersion;
use glam::DVec3;

use super::coating::Coating;

/// Number of aspheric terms: r², r⁴ … r²⁰.
pub const ASPHERE_TERMS: usize = 10;

/// Effect of a surface on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SurfaceKind {
    /// Snell's law, or no effect between equal media.
    Refracting,
    /// Reflection; the space behind has the medium of the space before.
    Mirror,
    /// A thin lens without aberrations in the vertex plane, between equal media: slopes change by −r/f.
    ThinLens {
        /// Focal length f, mm; not 0.
        focal_length_mm: f64,
    },
}

/// One surface and the space behind it, in the unfolded lens: light travels towards +z everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Effect on rays.
    pub kind: SurfaceKind,
    /// Radius of curvature, mm, positive if the centre lies behind the surface as the light meets it; infinite for a plane.
    pub radius_mm: f64,
    /// Conic constant k.
    pub conic: f64,
    /// αᵢ of r²ⁱ, mm^(1 − 2i), i = 1 … 10.
    pub asphere: [f64; ASPHERE_TERMS],
    /// Radius of the clear aperture, mm.
    pub semi_aperture_mm: f64,
    /// Radius about the axis within which the surface stops light, mm: a hole of a mirror, or a disc before the surface. 0 for none.
    pub obscured_radius_mm: f64,
    /// Distance along the path of the light to the next surface, mm; ignored for the last.
    pub thickness_mm: f64,
    /// Medium behind the surface; ignored for a mirror.
    pub glass: Dispersion,
    /// Coating; a constant is the reflectance of a mirror.
    pub coating: Coating,
    /// True for the aperture stop.
    pub stop: bool,
}

impl Surface {
    /// A refracting sphere (or plane, for an infinite radius) without coating.
    #[must_use]
    pub fn sphere(radius_mm: f64, thickness_mm: f64, glass: Dispersion, semi_aperture_mm: f64) -> Self {
        Self {
            kind: SurfaceKind::Refracting,
            radius_mm,
            conic: 0.0,
            asphere: [0.0; ASPHERE_TERMS],
            semi_aperture_mm,
            obscured_radius_mm: 0.0,
            thickness_mm,
            glass,
            coating: Coating::Uncoated,
            stop: false,
        }
    }

    /// A spherical (or plane) mirror in air that reflects all light.
    #[must_use]
    pub fn mirror(radius_mm: f64, thickness_mm: f64, semi_aperture_mm: f64) -> Self {
        let kind = SurfaceKind::Mirror;
        Self { kind, ..Self::sphere(radius_mm, thickness_mm, Dispersion::AIR, semi_aperture_mm) }
    }

    /// True for a mirror.
    #[must_use]
    pub fn is_mirror(&self) -> bool {
        self.kind == SurfaceKind::Mirror
    }

    /// Sag at a distance from the axis in the space behind the surface, mm; `None` beyond the equator.
    pub(crate) fn sag_behind(&self, r: f64) -> Option<f64> {
        self.shape().sag(r).map(|sag| if self.is_mirror() { -sag } else { sag })
    }

    /// A stop in air.
    #[must_use]
    pub fn stop(thickness_mm: f64, semi_aperture_mm: f64) -> Self {
        Self { stop: true, ..Self::sphere(f64::INFINITY, thickness_mm, Dispersion::AIR, semi_aperture_mm) }
    }

    pub(crate) fn shape(&self) -> Shape {
        Shape::new(1.0 / self.radius_mm, self.conic, self.asphere)
    }
}

/// The shape of a surface, its vertex at the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shape {
    Plane,
    /// Curvature, 1/mm.
    Sphere(f64),
    Conic(Conic),
    Asphere(Asphere),
}

/// Curvature and conic constant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Conic {
    c: f64,
    k: f64,
}

/// A conic and terms of even powers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Asphere {
    conic: Conic,
    terms: [f64; ASPHERE_TERMS],
}

/// Intersection of a ray with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SurfaceHit {
    /// Position relative to the surface's vertex, mm.
    pub(super) point: DVec3,
    /// Unit normal, towards the sensor at the vertex.
    pub(super) normal: DVec3,
}

impl Shape {
    pub(super) fn new(c: f64, k: f64, terms: [f64; ASPHERE_TERMS]) -> Self {
        let conic = Conic { c, k };
        if terms.iter().any(|a| *a != 0.0) {
            Self::Asphere(Asphere { conic, terms })
        } else if c == 0.0 {
            Self::Plane
        } else if k == 0.0 {
            Self::Sphere(c)
        } else {
            Self::Conic(conic)
        }
    }

    /// Intersection of the ray from `p` (relative to the vertex) along the unit vector `d`, in the direction `sense` (1 towards the sensor, −1
    /// towards the scene); `None` if there is none.
    #[inline]
    pub(super) fn hit(&self, p: DVec3, d: DVec3, sense: f64) -> Option<SurfaceHit> {
        match self {
            Self::Plane => plane_hit(p, d, sense),
            Self::Sphere(c) => sphere_hit(*c, p, d, sense),
            Self::Conic(conic) => conic.hit(p, d, sense),
            Self::Asphere(asphere) => asphere.hit(p, d, sense),
        }
    }

    /// Sag at a distance from the axis, mm; `None` beyond the equator.
    pub(crate) fn sag(&self, r: f64) -> Option<f64> {
        match self {
            Self::Plane => Some(0.0),
            Self::Sphere(c) => Conic { c: *c, k: 0.0 }.sag(r * r).map(|s| s[0]),
            Self::Conic(conic) => conic.sag(r * r).map(|s| s[0]),
            Self::Asphere(asphere) => asphere.sag(r * r).map(|s| s[0]),
        }
    }

    /// Curvature at the vertex, 1/mm, including the r² term of an asphere.
    pub(super) fn vertex_curvature(&self) -> f64 {
        match self {
            Self::Plane => 0.0,
            Self::Sphere(c) => *c,
            Self::Conic(conic) => conic.c,
            Self::Asphere(asphere) => asphere.conic.c + 2.0 * asphere.terms[0],
        }
    }
}

#[inline]
fn plane_hit(p: DVec3, d: DVec3, sense: f64) -> Option<SurfaceHit> {
    if d.z * sense <= 0.0 {
        return None;
    }
    let t = -p.z / d.z;
    Some(SurfaceHit { point: DVec3::new(p.x + t * d.x, p.y + t * d.y, 0.0), normal: DVec3::Z })
}

/// c |p + t d|² = 2 (p + t d)_z: c t² − 2 b t + q = 0, and direction · normal at the root is b − c t = ± √(b² − c q).
#[inline]
fn sphere_hit(c: f64, p: DVec3, d: DVec3, sense: f64) -> Option<SurfaceHit> {
    let b = d.z - c * p.dot(d);
    let q = c * p.length_squared() - 2.0 * p.z;
    let t = root(c, b, q, sense)?;
    let point = p + d * t;
    let normal = DVec3::new(-c * point.x, -c * point.y, 1.0 - c * point.z);
    (normal.z > 0.0).then_some(SurfaceHit { point, normal })
}

/// The root of a t² − 2 b t + q = 0 at which b − a t has the sign of `sense`, without cancellation.
#[inline]
fn root(a: f64, b: f64, q: f64, sense: f64) -> Option<f64> {
    let square = b * b - a * q;
    if square.is_nan() || square <= 0.0 {
        return None;
    }
    let slope = sense * square.sqrt();
    let t = if b * sense >= 0.0 { q / (b + slope) } else { (b - slope) / a };
    t.is_finite().then_some(t)
}

impl Conic {
    #[inline]
    fn hit(&self, p: DVec3, d: DVec3, sense: f64) -> Option<SurfaceHit> {
        let Self { c, k } = *self;
        let a = c * (1.0 + k * d.z * d.z);
        let b = d.z - c * (p.dot(d) + k * p.z * d.z);
        let q = c * (p.length_squared() + k * p.z * p.z) - 2.0 * p.z;
        let t = root(a, b, q, sense)?;
        let point = p + d * t;
        let gradient = DVec3::new(-c * point.x, -c * point.y, 1.0 - c * (1.0 + k) * point.z);
        (gradient.z > 0.0).then(|| SurfaceHit { point, normal: gradient.normalize() })
    }

    /// Sag and its derivative by r², at r².
    fn sag(&self, r2: f64) -> Option<[f64; 2]> {
        let square = 1.0 - (1.0 + self.k) * self.c * self.c * r2;
        (square > 0.0).then(|| {
            let s = square.sqrt();
            [self.c * r2 / (1.0 + s), 0.5 * self.c / s]
        })
    }
}

/// Maximum Newton steps before a ray counts as missing an asphere; convergence is quadratic and needs four or five.
const NEWTON_STEPS: usize = 40;

impl Asphere {
    /// Safeguarded Newton on f(t) = z(t) − sag(r²(t)), started at the conic's own intersection (or the vertex plane's). A step that does not lower
    /// |f| is halved.
    fn hit(&self, p: DVec3, d: DVec3, sense: f64) -> Option<SurfaceHit> {
        let start = self.conic.hit(p, d, sense).or_else(|| plane_hit(p, d, sense))?.point;
        let (mut t, mut step) = ((start - p).dot(d), 0.0_f64);
        let mut f = self.residual(p + d * t, d);
        for _ in 0..NEWTON_STEPS {
            let [value, slope] = f?;
            // A residual of a few units in the last place of the coordinates cannot be lowered.
            if value.abs() <= 4.0 * f64::EPSILON * (1.0 + t.abs())
                || (step != 0.0 && step.abs() < 1e-15 * (1.0 + t.abs()))
            {
                return self.at(p + d * t, d, sense);
            }
            step = -value / slope;
            let mut next = self.residual(p + d * (t + step), d);
            while next.is_none_or(|[v, _]| v.abs() >= value.abs()) && step.abs() > 1e-15 * (1.0 + t.abs()) {
                step *= 0.5;
                next = self.residual(p + d * (t + step), d);
            }
            (t, f) = (t + step, next);
        }
        None
    }

    /// z − sag at a point, and its derivative along `d`.
    fn residual(&self, point: DVec3, d: DVec3) -> Option<[f64; 2]> {
        let [sag, slope] = self.sag(point.x * point.x + point.y * point.y)?;
        Some([point.z - sag, d.z - 2.0 * slope * (point.x * d.x + point.y * d.y)])
    }

    fn at(&self, point: DVec3, d: DVec3, sense: f64) -> Option<SurfaceHit> {
        let [_, slope] = self.sag(point.x * point.x + point.y * point.y)?;
        let normal = DVec3::new(-2.0 * slope * point.x, -2.0 * slope * point.y, 1.0).normalize();
        (d.dot(normal) * sense > 0.0).then_some(SurfaceHit { point, normal })
    }

    fn sag(&self, r2: f64) -> Option<[f64; 2]> {
        let [mut sag, mut slope] = self.conic.sag(r2)?;
        let (mut polynomial, mut derivative) = (0.0, 0.0);
        for (i, a) in self.terms.iter().enumerate().rev() {
            polynomial = (polynomial + a) * r2;
            derivative = derivative * r2 + (i + 1) as f64 * a;
        }
        sag += polynomial;
        slope += derivative;
        Some([sag, slope])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn terms(a4: f64, a6: f64) -> [f64; ASPHERE_TERMS] {
        let mut terms = [0.0; ASPHERE_TERMS];
        (terms[1], terms[2]) = (a4, a6);
        terms
    }

    proptest! {
        /// A ray aimed at a point of the surface finds that point, from either side and at any angle that crosses.
        #[test]
        fn a_ray_finds_the_point_it_is_aimed_at(
            c in -0.09..0.09_f64, k in -3.0..1.0_f64, a4 in -1e-5..1e-5_f64, x in -6.0..6.0_f64, y in -6.0..6.0_f64,
            dx in -0.9..0.9_f64, dy in -0.3..0.3_f64, back in 0.0..20.0_f64, form in 0..4, towards_scene: bool,
        ) {
            let shape = match form {
                0 => Shape::new(0.0, 0.0, terms(0.0, 0.0)),
                1 => Shape::new(c, 0.0, terms(0.0, 0.0)),
                2 => Shape::new(c, k, terms(0.0, 0.0)),
                _ => Shape::new(c, k, terms(a4, -a4 * 1e-3)),
            };
            let sense = if towards_scene { -1.0 } else { 1.0 };
            let Some(sag) = shape.sag((x * x + y * y).sqrt()) else { return Ok(()) };
            let target = DVec3::new(x, y, sag);
            let d = DVec3::new(dx, dy, sense).normalize();
            let Some(hit) = shape.hit(target - d * back, d, sense) else {
                // Only where the ray crosses in the other sense at the target.
                let slope = (shape.sag((x * x + y * y).sqrt() + 1e-6).unwrap_or(sag) - sag) / 1e-6;
                let radial = DVec3::new(x, y, 0.0).normalize_or_zero();
                prop_assert!(d.dot(DVec3::Z - radial * slope) * sense < 1e-3);
                return Ok(());
            };
            prop_assert!((shape.sag((hit.point.x * hit.point.x + hit.point.y * hit.point.y).sqrt()).expect("on it") - hit.point.z).abs() < 1e-12);
            prop_assert!((hit.normal.length() - 1.0).abs() < 1e-12 && d.dot(hit.normal) * sense > 0.0);
            // A quadric has one crossing in this sense; an asphere may have several.
            if form < 3 {
                prop_assert!((hit.point - target).length() < 1e-8, "{:?} {:?}", hit.point, target);
            }
        }
    }

    #[test]
    fn an_asphere_of_conic_form_is_the_conic() {
        // r⁴ and r⁶ of a paraboloid are zero, those of a sphere are c³/8 and c⁵/16; the rest is below 1e-9 here.
        let c = 0.01;
        let sphere = Shape::new(c, 0.0, [0.0; ASPHERE_TERMS]);
        let asphere = Shape::new(c, -1.0, terms(c * c * c / 8.0, c * c * c * c * c / 16.0));
        let (p, d) = (DVec3::new(3.0, 1.0, -20.0), DVec3::new(0.05, -0.02, 1.0).normalize());
        let [a, b] = [&sphere, &asphere].map(|shape| shape.hit(p, d, 1.0).expect("a hit").point);
        assert!((a - b).length() < 1e-9, "{a} {b}");
    }

    #[test]
    fn a_sphere_is_hit_as_far_as_its_equator() {
        let dome = Shape::new(0.1, 0.0, [0.0; ASPHERE_TERMS]);
        // Straight across at 9 mm depth, from the side: crosses the dome's wall outwards, 0.5 mm before the equator.
        let inside = DVec3::new(0.0, 0.0, 9.5);
        let hit = dome.hit(inside, DVec3::X, -1.0).expect("the wall");
        assert!((hit.point.x - (100.0_f64 - 0.25).sqrt()).abs() < 1e-12);
        assert!(dome.hit(DVec3::new(0.0, 0.0, 10.5), DVec3::X, -1.0).is_none(), "beyond the equator");
        assert!(dome.hit(DVec3::new(12.0, 0.0, -5.0), DVec3::Z, 1.0).is_none(), "beside it");
    }
}
