//! A windscreen: laminated, tilted, curved glass between the camera and the scene.
//!
//! **Modelled**: Snell's law at every face (lateral offset, and the deflection by curvature and by a wedge); Fresnel losses (or those of a coating)
//! at the two outer faces and Fresnel losses at the faces between layers; absorption in the bulk, with the internal transmittance τ of a reference
//! thickness d scaled to a path ℓ by τ^(ℓ/d) (Beer and Lambert); the double image: light reflected once at each outer face inside the glass, R² of
//! the direct light.
//!
//! Drops of water may lie on the outer face: [`Drops`]. There light passes from glass into water, whatever the coating.
//!
//! **Left out**: light reflected more than twice (R⁴, some 10⁻⁶ at normal incidence) or between the layers (n 1.52 to 1.48: 2·10⁻⁴); polarisation
//! (each face uses the mean); coherence; edges (the glass is unbounded); scatter.
//!
//! Frame: origin on the inner face, z outwards along its normal, x to the right, y down. Positive tilt leans the upper edge
//! towards the camera, as in cars.

mod face;
#[cfg(test)]
mod wet_tests;

use glam::DVec3;

use super::drops::{Drops, DropsParameters};
use super::{MemberRay, RayOutcome};
use crate::prescription::coating::{Coating, Crossing};
use crate::{error::FrontError, overlap::PRINCIPAL_NM};
use face::{Face, check};

pub use face::{Layer, Tint, WindscreenParameters};

/// About R² of glass in air, twice 4 %.
const TYPICAL_DOUBLE_FRACTION: f64 = 0.002;

/// Light path through the glass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum LightPath {
    /// Refracted only.
    Direct,
    /// Reflected at the outer face, then (seen from the camera) at the inner face.
    DoubleReflection,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Windscreen {
    parameters: WindscreenParameters,
    faces: Vec<Face>,
    thickness_mm: f64,
    double_image_fraction: f64,
    drops: Option<Box<Drops>>,
}

impl Windscreen {
    /// Creates a windscreen.
    ///
    /// # Errors
    /// If a number is outside its range, or the glass is behind or inside the camera.
    pub fn new(parameters: WindscreenParameters) -> Result<Self, FrontError> {
        check(&parameters)?;
        let faces = face::faces(&parameters);
        let thickness_mm = parameters.layers.iter().map(|layer| layer.thickness_mm).sum();
        let mut glass = Self { parameters, faces, thickness_mm, double_image_fraction: 0.0, drops: None };
        glass.double_image_fraction = match glass.parameters.double_image_fraction {
            Some(fraction) => fraction,
            None => glass.untinted().double_fraction(),
        };
        Ok(glass)
    }

    /// The same glass with drops of water on its outer face.
    ///
    /// # Errors
    /// If a number is outside its range, or the glass ends before the drops.
    pub fn with_drops(self, parameters: DropsParameters) -> Result<Self, FrontError> {
        let outer = self.faces[self.faces.len() - 1];
        let drops = Drops::new(parameters, &|place_mm| outer.at(place_mm))?;
        Ok(Self { drops: Some(Box::new(drops)), ..self })
    }

    /// The same glass with the drops at a time, s; `down` is the direction of gravity in the camera frame.
    pub(super) fn at(&self, time_s: f64, down: DVec3) -> Self {
        let outer = self.faces[self.faces.len() - 1];
        let changed = self.drops().and_then(|drops| {
            let course = drops.parameters().course.as_ref()?;
            let down = self.parameters.placement.rotation.transpose() * down;
            drops.at(course, time_s, down, &|place_mm| outer.at(place_mm)).ok()
        });
        match changed {
            Some(drops) => Self { drops: Some(Box::new(drops)), ..self.clone() },
            None => self.clone(),
        }
    }

    /// Drops on the outer face.
    #[must_use]
    pub fn drops(&self) -> Option<&Drops> {
        self.drops.as_deref()
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &WindscreenParameters {
        &self.parameters
    }

    /// Thickness along the normal, mm.
    #[must_use]
    pub fn thickness_mm(&self) -> f64 {
        self.thickness_mm
    }

    /// Fraction of samples that trace the double image.
    #[must_use]
    pub fn double_image_fraction(&self) -> f64 {
        self.double_image_fraction
    }

    /// Transmittances on the camera's axis at 587.56 nm: direct and double image; `None` if the axis misses the glass.
    #[must_use]
    pub fn axial_transmittances(&self) -> Option<[f64; 2]> {
        let axis = MemberRay { point_mm: DVec3::ZERO, direction: DVec3::Z };
        match (
            self.through(axis, PRINCIPAL_NM, LightPath::Direct),
            self.through(axis, PRINCIPAL_NM, LightPath::DoubleReflection),
        ) {
            (RayOutcome::Transmitted(_, straight), RayOutcome::Transmitted(_, doubled)) => Some([straight, doubled]),
            (RayOutcome::Transmitted(_, straight), _) => Some([straight, 0.0]),
            _ => None,
        }
    }

    /// The glass without its tint, which may be opaque at the wavelength of the axial transmittances only.
    fn untinted(&self) -> Self {
        let parameters = WindscreenParameters { tint: None, ..self.parameters.clone() };
        Self { parameters, ..self.clone() }
    }

    /// Fraction of the double image in the axial light; that of usual glass if the axis misses this one.
    fn double_fraction(&self) -> f64 {
        let fraction = |[straight, doubled]: [f64; 2]| (straight > 0.0).then(|| doubled / (straight + doubled));
        self.axial_transmittances().and_then(fraction).unwrap_or(TYPICAL_DOUBLE_FRACTION)
    }

    /// True if a ray or its weight depends on the wavelength.
    #[must_use]
    pub fn disperses(&self) -> bool {
        let p = &self.parameters;
        p.layers.iter().any(|layer| layer.index.varies())
            || p.tint.as_ref().is_some_and(|tint| tint.transmittance.varies())
            || matches!(p.coating, Coating::QuarterWave { .. })
            || self.drops().is_some_and(|drops| drops.parameters().index.varies())
    }

    /// Selects the light path of a sample by its first number; returns the path, the rescaled number, and the inverse probability.
    pub(super) fn choose(&self, u: f64) -> (LightPath, f64, f64) {
        let q = self.double_image_fraction;
        if u < q {
            (LightPath::DoubleReflection, u / q, 1.0 / q)
        } else {
            (LightPath::Direct, (u - q) / (1.0 - q), 1.0 / (1.0 - q))
        }
    }

    /// True if a point of the camera frame is on the camera's side.
    fn is_before(&self, point_mm: DVec3) -> bool {
        let local = self.parameters.placement.inward(MemberRay { point_mm, direction: DVec3::Z });
        self.faces[0].height(local.point_mm).0 < 0.0
    }

    /// Checks that `points` of the lens are before the glass and that one of `lines` passes through it.
    pub(super) fn check(&self, points: &[DVec3], lines: &[MemberRay]) -> Result<(), FrontError> {
        if !points.iter().all(|point| self.is_before(*point)) {
            return Err(FrontError::ThroughLens);
        }
        let (mut goes, mut over) = (false, self.drops.is_none());
        for line in lines {
            match self.through(*line, PRINCIPAL_NM, LightPath::Direct) {
                RayOutcome::Absorbed => return Err(FrontError::FacesCross),
                RayOutcome::Transmitted(out, _) => {
                    goes = true;
                    let local = self.parameters.placement.inward(out);
                    over = over || self.drops().is_some_and(|drops| drops.is_over(local.point_mm));
                }
                RayOutcome::Missed => {}
            }
        }
        match (goes, over) {
            (false, _) => Err(FrontError::NotLookedThrough),
            (true, false) => Err(FrontError::DropsNotSeen),
            (true, true) => Ok(()),
        }
    }

    /// Internal transmittance of a path in the glass.
    fn bulk(&self, path_mm: f64, nm: f64) -> f64 {
        match &self.parameters.tint {
            None => 1.0,
            Some(tint) => {
                let reference_mm = tint.thickness_mm.unwrap_or(self.thickness_mm);
                etendue_core::maths::f64::pow(tint.transmittance.at(nm), path_mm / reference_mm)
            }
        }
    }
}

/// A ray during its passage through the glass.
struct Passage<'a> {
    glass: &'a Windscreen,
    /// Drops on the outer face.
    drops: Option<&'a Drops>,
    /// The drop that wets the outer face where the ray last met it.
    wetting_drop: Option<usize>,
    nm: f64,
    line: MemberRay,
    /// The current medium: 0 is air inside, 1 the first layer, the last air outside.
    medium: usize,
    weight: f64,
    path_mm: f64,
}

impl Windscreen {
    /// Traces a ray from the camera through dry glass.
    pub(super) fn through(&self, line: MemberRay, nm: f64, path: LightPath) -> RayOutcome {
        self.beyond(None, line, nm, path)
    }

    /// Traces a ray from the camera through the glass and its drops.
    pub(super) fn through_wet(&self, line: MemberRay, nm: f64, path: LightPath) -> RayOutcome {
        self.beyond(self.drops(), line, nm, path)
    }

    fn beyond(&self, drops: Option<&Drops>, line: MemberRay, nm: f64, path: LightPath) -> RayOutcome {
        let placement = &self.parameters.placement;
        match through(self, drops, placement.inward(line), nm, path) {
            RayOutcome::Transmitted(out, fraction) => RayOutcome::Transmitted(placement.outward(out), fraction),
            other => other,
        }
    }
}

fn through(glass: &Windscreen, drops: Option<&Drops>, line: MemberRay, nm: f64, path: LightPath) -> RayOutcome {
    let outer = glass.faces.len() - 1;
    let mut passage = Passage { glass, drops, wetting_drop: None, nm, line, medium: 0, weight: 1.0, path_mm: 0.0 };
    if glass.faces[0].crossed(&line, 1.0).is_none() {
        return RayOutcome::Missed;
    }
    match passage.run(outer, path) {
        Some(()) => RayOutcome::Transmitted(passage.line, passage.weight * glass.bulk(passage.path_mm, nm)),
        None => RayOutcome::Absorbed,
    }
}

impl Passage<'_> {
    fn run(&mut self, outer: usize, path: LightPath) -> Option<()> {
        (0..outer).try_for_each(|face| self.refract(face, 1.0).map(drop))?;
        if path == LightPath::DoubleReflection {
            self.reflect(outer, 1.0)?;
            (1..outer).rev().try_for_each(|face| self.refract(face, -1.0).map(drop))?;
            self.reflect(0, -1.0)?;
            (1..outer).try_for_each(|face| self.refract(face, 1.0).map(drop))?;
        }
        let normal = self.refract(outer, 1.0)?;
        let Some(drops) = self.drops else { return Some(()) };
        let (line, fraction) = drops.leave(self.line, normal, self.wetting_drop, self.nm)?;
        self.line = line;
        self.weight *= fraction;
        Some(())
    }

    fn index(&self, medium: usize) -> f64 {
        match medium.checked_sub(1).and_then(|i| self.glass.parameters.layers.get(i)) {
            Some(layer) => layer.index.at(self.nm),
            None => match self.drops.filter(|_| medium > 0 && self.wetting_drop.is_some()) {
                Some(drops) => drops.index(self.nm),
                None => 1.0,
            },
        }
    }

    /// Advances the ray to a face; returns the outward normal.
    fn arrive(&mut self, face: usize, sense: f64) -> Option<DVec3> {
        let (point_mm, normal) = self.glass.faces[face].crossed(&self.line, sense)?;
        if self.medium > 0 {
            self.path_mm += (point_mm - self.line.point_mm).length();
        }
        self.line.point_mm = point_mm;
        if let Some(drops) = self.drops.filter(|_| face + 1 == self.glass.faces.len()) {
            self.wetting_drop = drops.wetting(point_mm);
        }
        Some(normal)
    }

    /// Indices and cosines of a crossing of a face; `None` for total reflection.
    fn crossing(&self, face: usize, sense: f64, normal: DVec3) -> Option<(Crossing, usize)> {
        let next = if sense > 0.0 { face + 1 } else { face };
        let n = [self.index(self.medium), self.index(next)];
        let along = self.line.direction.dot(normal).abs();
        let ratio = n[0] / n[1];
        let square = 1.0 - ratio * ratio * (1.0 - along * along);
        (square > 0.0).then(|| (Crossing { n, cosine: [along, square.sqrt()] }, next))
    }

    fn coating(&self, face: usize) -> &Coating {
        let outer = self.glass.faces.len() - 1;
        let is_dry = face == 0 || (face == outer && self.wetting_drop.is_none());
        if is_dry { &self.glass.parameters.coating } else { &Coating::Uncoated }
    }

    /// Refracts at a face; returns the outward normal.
    fn refract(&mut self, face: usize, sense: f64) -> Option<DVec3> {
        let normal = self.arrive(face, sense)?;
        let (crossing, next) = self.crossing(face, sense, normal)?;
        self.weight *= self.coating(face).transmittance(&crossing, self.nm);
        let (ratio, [along, beyond]) = (crossing.n[0] / crossing.n[1], crossing.cosine);
        let direction = self.line.direction * ratio + normal * (sense * (beyond - ratio * along));
        self.line.direction = direction.normalize();
        self.medium = next;
        Some(normal)
    }

    /// Reflects at an outer face from within.
    fn reflect(&mut self, face: usize, sense: f64) -> Option<()> {
        let normal = self.arrive(face, sense)?;
        let (crossing, _) = self.crossing(face, sense, normal)?;
        self.weight *= 1.0 - self.coating(face).transmittance(&crossing, self.nm);
        let direction = self.line.direction;
        self.line.direction = direction - normal * (2.0 * direction.dot(normal));
        Some(())
    }
}
