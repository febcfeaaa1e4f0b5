//! Paths that branch at the first surface (splitting; Arvo and Kirk, "Particle transport and image synthesis", 1990): from one point that
//! the camera sees, found once, several lights are drawn and several paths go on.
//!
//! What it takes to come there (the ray through the lens, the textures, the cut of lights that the draws share) is paid once, and the
//! light of lamps and of other surfaces has the noise of as many more samples. Edges, depth of field and motion do not: their noise goes
//! by samples. A path branches once, at the first surface that is no mirror; points in media, drops and flakes let it go on whole. Each branch
//! counts its part, and densities are those of all branches and draws together, so that multiple importance sampling weighs as many of both.

use etendue_core::{FieldRay, Spectral};

use super::effects::Effects;
use super::path::{Path, PathStep, Vertex};
use crate::lights::LightSampleContext;

impl<'a, const N: usize, E: Effects> Path<'a, N, E> {
    /// How many paths go on from a surface that the path has met.
    #[inline(always)]
    pub(super) fn branches(&self, vertex: &Vertex<'a, N>) -> u32 {
        let here = self.branches && self.history.is_seen() && !(E::SURFACES && vertex.bsdf.is_delta());
        if here { self.tracer.settings.branches } else { 1 }
    }

    /// Follows all branches to their ends.
    #[inline(never)]
    pub(super) fn branch(&mut self, vertex: &Vertex<'a, N>, receiver: &LightSampleContext) -> PathStep {
        let of = receiver.draws;
        for k in 0..of {
            let asked = FieldRay { stream: self.asked.stream.branch(k, of), ..*self.asked };
            let (throughput, radiance) = (self.throughput / of as f32, Spectral::ZERO);
            let mut branch = Path { asked: &asked, branches: false, throughput, radiance, ..self.clone() };
            let found = match branch.scatter_on(vertex, receiver) {
                PathStep::Ends => branch.radiance,
                PathStep::Goes => {
                    branch.met += 1;
                    branch.follow()
                }
            };
            self.radiance += found;
        }
        PathStep::Ends
    }
}
