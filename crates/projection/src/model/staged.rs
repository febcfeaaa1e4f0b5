//! A symmetrical model followed by a map of its image plane.

use glam::{DVec2, DVec3};

use super::profile::{Edge, Profile, Projection, Sight};
use crate::plane::{Affine, Distortion};

/// r(θ), then a distortion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distorted<P> {
    pub(super) profile: P,
    pub(super) distortion: Distortion,
}

impl<P: Profile> Projection for Distorted<P> {
    fn edge(&self) -> Edge {
        let fold = self.distortion.fold().and_then(|radius| self.profile.angle(radius));
        let edge = Profile::edge(&self.profile);
        fold.map_or(edge, |angle| edge.nearer(Edge::fold(angle)))
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        self.distortion.distorted(self.profile.project(direction)?)
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        self.profile.unproject(self.distortion.ideal(point)?)
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        let ideal = self.distortion.ideal(point)?;
        Some(self.profile.solid_angle_per_area(ideal)? / self.distortion.area_ratio(ideal))
    }

    fn sight(&self, point: DVec2) -> Option<Sight> {
        let ideal = self.distortion.ideal(point)?;
        Some(self.profile.sight(ideal)?.enlarged(self.distortion.area_ratio(ideal)))
    }
}

/// r(θ), then an affine map.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stretched<P> {
    pub(super) profile: P,
    pub(super) affine: Affine,
}

impl<P: Profile> Projection for Stretched<P> {
    fn edge(&self) -> Edge {
        Profile::edge(&self.profile)
    }

    fn project(&self, direction: DVec3) -> Option<DVec2> {
        Some(self.affine.there(self.profile.project(direction)?))
    }

    fn unproject(&self, point: DVec2) -> Option<DVec3> {
        self.profile.unproject(self.affine.back(point))
    }

    fn solid_angle_per_area(&self, point: DVec2) -> Option<f64> {
        Some(self.profile.solid_angle_per_area(self.affine.back(point))? / self.affine.area_ratio())
    }

    fn sight(&self, point: DVec2) -> Option<Sight> {
        Some(self.profile.sight(self.affine.back(point))?.enlarged(self.affine.area_ratio()))
    }
}
