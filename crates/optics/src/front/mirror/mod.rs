//! A mirror in the view of the camera: a catadioptric camera.
//!
//! Rays are reflected exactly, d′ = d − 2 (d·n) n, for any mirror shape and pupil position; a single viewpoint is not assumed. It exists (Baker and
//! Nayar, "A theory of single-viewpoint catadioptric image formation", 1999) for a hyperboloid with the pupil at its outer focus, and for a
//! paraboloid under parallel rays.
//!
//! The mirror's frame: z along its axis, away from the camera in the unrotated state; the reflecting side is the outer side of a convex quadric about
//! +z, or the front (counter-clockwise) side of a mesh. The other side is black. A ray that misses the mirror or goes through its hole is unchanged.
//! Left out: a second reflection at the mirror, the body of the camera (which appears at the centre of real images), roughness.

mod mesh;
mod quadric;
mod reflectance;

use super::{FrontError, MemberRay, Placement, RayOutcome};

pub use mesh::MeshMirror;
pub use quadric::{Quadric, QuadricKind};
pub use reflectance::Reflectance;

pub(super) use mesh::MirrorHit;

/// The surface of a mirror: the closed list.
#[derive(Clone, Debug, PartialEq)]
pub enum MirrorShape {
    /// Sphere, cone, paraboloid, hyperboloid.
    Quadric(Quadric),
    /// Triangles with smooth normals.
    Mesh(Box<MeshMirror>),
}

/// Parameters of a mirror.
#[derive(Clone, Debug, PartialEq)]
pub struct MirrorParameters {
    /// Its surface.
    pub shape: MirrorShape,
    /// Placement: a quadric has its vertex (a cone its apex) at the origin.
    pub placement: Placement,
    /// Reflected fraction of the light.
    pub reflectance: Reflectance,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Mirror {
    parameters: MirrorParameters,
}

/// The camera's view of the mirror along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum MirrorVisibility {
    Past,
    Front,
    Back,
}

impl Mirror {
    /// Creates a mirror.
    ///
    /// # Errors
    /// If its reflectance is invalid.
    pub fn new(parameters: MirrorParameters) -> Result<Self, FrontError> {
        parameters.reflectance.check()?;
        Ok(Self { parameters })
    }

    /// Construction parameters.
    #[must_use]
    pub fn parameters(&self) -> &MirrorParameters {
        &self.parameters
    }

    /// Reflected fraction of the light.
    #[must_use]
    pub fn reflectance(&self) -> &Reflectance {
        &self.parameters.reflectance
    }

    fn intersect(&self, local: &MemberRay) -> Option<MirrorHit> {
        match &self.parameters.shape {
            MirrorShape::Quadric(quadric) => quadric.intersect(local),
            MirrorShape::Mesh(mesh) => mesh.intersect(local),
        }
    }

    pub(super) fn reflect(&self, line: MemberRay, nm: f64) -> RayOutcome {
        let local = self.parameters.placement.inward(line);
        let Some(touch) = self.intersect(&local) else { return RayOutcome::Missed };
        if local.direction.dot(touch.facing) >= 0.0 {
            return RayOutcome::Absorbed;
        }
        // At the edge of a coarse mesh the smooth normal may face away: light would be reflected into the mirror.
        let normal = if local.direction.dot(touch.normal) < 0.0 { touch.normal } else { touch.facing };
        let along = local.direction.dot(normal);
        let direction = (local.direction - normal * (2.0 * along)).normalize();
        let out = self.parameters.placement.outward(MemberRay { point_mm: touch.point_mm, direction });
        RayOutcome::Transmitted(out, self.parameters.reflectance.at(nm, along.abs()))
    }

    fn visibility(&self, line: &MemberRay) -> MirrorVisibility {
        let local = self.parameters.placement.inward(*line);
        match self.intersect(&local) {
            None => MirrorVisibility::Past,
            Some(touch) if local.direction.dot(touch.facing) < 0.0 => MirrorVisibility::Front,
            Some(_) => MirrorVisibility::Back,
        }
    }

    /// Checks that the camera, looking along `lines`, sees the mirror from the correct side.
    pub(super) fn check(&self, lines: &[MemberRay]) -> Result<(), FrontError> {
        // For a mesh, which may be open, the back side alone decides.
        let inside = |line: &MemberRay| match &self.parameters.shape {
            MirrorShape::Quadric(quadric) => quadric.holds(self.parameters.placement.inward(*line).point_mm),
            MirrorShape::Mesh(_) => false,
        };
        let sees = |sight: MirrorVisibility| lines.iter().any(|line| self.visibility(line) == sight);
        if lines.iter().any(inside) || (sees(MirrorVisibility::Back) && !sees(MirrorVisibility::Front)) {
            return Err(FrontError::SeenFromInside);
        }
        if sees(MirrorVisibility::Front) { Ok(()) } else { Err(FrontError::NotVisible) }
    }
}
