//! Glowing surfaces that move: each is asked as the light that it is at the receiver's time.
//!
//! What the choice among lights knows of one holds for the whole interval of the view, and so does the probability of its choice;
//! everything else, drawn or met, is that of the light made for the moment.

use super::light_sample::{LightHit, LightSample};
use super::sample_context::LightSampleContext;
use super::sphere::{SphereLight, SphereLook};
use super::tree::LightBounds;
use super::triangle::{Facets, TriangleLight};
use super::way::Way;
use crate::MaterialId;
use crate::materials::MaterialTable;
use etendue_core::{TimeInterval, Wavelengths};
use glam::{DVec3, Vec2};

/// A triangle, a parallelogram or a sphere in motion.
#[derive(Clone, Debug)]
pub(super) struct MovingLight {
    shape: Shape,
    way: Way,
    material: MaterialId,
}

#[derive(Clone, Debug)]
enum Shape {
    Facets(Facets),
    Sphere { radius_m: f64, look: SphereLook },
}

impl MovingLight {
    pub(super) fn of_facets(facets: Facets, way: Way, material: MaterialId) -> Self {
        Self { shape: Shape::Facets(facets), way, material }
    }

    pub(super) fn of_sphere(radius_m: f64, way: Way, material: MaterialId, material_table: &MaterialTable) -> Self {
        Self { shape: Shape::Sphere { radius_m, look: SphereLook::of(material, material_table) }, way, material }
    }

    /// How many triangles it is.
    pub(super) fn triangles(&self) -> usize {
        match &self.shape {
            Shape::Facets(facets) => facets.triangles(),
            Shape::Sphere { .. } => 0,
        }
    }

    /// For the choice among lights, at a mean radiance, `both` sides of triangles glow or only the front; `None` where it has no
    /// area at any moment.
    pub(super) fn bounds(&self, radiance: f64, both: bool) -> Option<LightBounds> {
        let Way { to_world, interval, .. } = &self.way;
        match &self.shape {
            Shape::Facets(facets) => {
                let moments = self.way.moments().filter_map(|place| facets.light(&place, self.material));
                let bounds = moments.map(|light| light.bounds(radiance, both)).collect();
                self.way.bounds(bounds, to_world.bounds_over(*interval, facets.own_box()))
            }
            Shape::Sphere { radius_m, look } => {
                let moments =
                    self.way.moments().map(|place| SphereLight::seen(*radius_m, &place, self.material, *look));
                let bounds = moments.map(|light| light.bounds(radiance)).collect();
                self.way.bounds(bounds, to_world.bounds_of_ball(*interval, DVec3::ZERO, *radius_m))
            }
        }
    }

    /// The point drawn for a receiver, without the probability of the choice.
    pub(super) fn sample<const N: usize>(
        &self,
        receiver: &LightSampleContext,
        u: Vec2,
        spread_rad: f32,
        material_table: &MaterialTable,
        asked: (&Wavelengths<N>, &TimeInterval),
    ) -> Option<LightSample<N>> {
        let from = receiver.position;
        let (glowing, drawn) = match self.at(receiver.time_s)? {
            Moment::Triangle(light) => (light.glowing(material_table), light.sample(from, u)?),
            Moment::Sphere(light) => (light.glowing(material_table), light.sample(from, u)?),
        };
        glowing.towards(&drawn, from, spread_rad, asked)
    }

    /// Density of what was met, without the probability of the choice, 1/sr.
    pub(super) fn pdf(&self, met: &LightHit<'_>) -> f32 {
        match self.at(met.point.time_s) {
            Some(Moment::Triangle(light)) => light.pdf(met),
            Some(Moment::Sphere(light)) => light.pdf(met),
            None => 0.0,
        }
    }

    fn at(&self, time_s: f32) -> Option<Moment> {
        let place = self.way.at(self.way.interval.moment(time_s));
        match &self.shape {
            Shape::Facets(facets) => Some(Moment::Triangle(facets.light(&place, self.material)?)),
            Shape::Sphere { radius_m, look } => {
                Some(Moment::Sphere(SphereLight::seen(*radius_m, &place, self.material, *look)))
            }
        }
    }
}

/// The light at a moment.
enum Moment {
    Triangle(TriangleLight),
    Sphere(SphereLight),
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Mesh;
    use etendue_core::track::{Interpolation, Key, Track};
    use etendue_core::{TimeInterval, maths};
    use glam::{DQuat, Vec3};

    /// At moments between those that are looked at: corners in the box, the normal in the cone (f32 rounds cosines to 1e-7).
    #[test]
    fn bounds_hold_the_light_at_every_moment() {
        let corners = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
        let mesh = Mesh::new(corners, vec![], vec![], vec![[0, 1, 2]], vec![]).expect("a mesh").0;
        let key = |i: f64| {
            let (sin, cos) = maths::f64::sin_cos(0.35 * i);
            let rotation = DQuat::from_xyzw(sin * 0.6, sin * 0.8, 0.0, cos);
            Key { time_s: i, position_m: DVec3::new(3.0 * i, i * i, -i), rotation, scale: DVec3::splat(2.0) }
        };
        for how in [Interpolation::Linear, Interpolation::Smooth] {
            let to_world = Track::new(&[0.0, 1.0, 3.0].map(key), how).expect("legal").into();
            let interval = TimeInterval::new(0.4, 1.3).expect("in order");
            let way = Way { to_world, origin_m: DVec3::new(0.5, 0.2, 0.1), interval };
            let light = MovingLight::of_facets(Facets::one(&mesh, 0), way, MaterialId(0));
            let bounds = light.bounds(3.0, false).expect("an area");
            assert!(bounds.theta_o > 0.2 && bounds.theta_o < 2.0, "{bounds:?}");
            let mut widest: f32 = 0.0;
            for i in 0..=1000_u16 {
                let Some(Moment::Triangle(moment)) = light.at(0.0009 * f32::from(i)) else { panic!("a triangle") };
                let own = moment.bounds(3.0, false);
                assert!(bounds.low.cmple(own.low).all() && own.high.cmple(bounds.high).all());
                let angle = maths::f32::atan2(own.axis.cross(bounds.axis).length(), own.axis.dot(bounds.axis));
                assert!(
                    angle <= bounds.theta_o && own.intensity <= bounds.intensity * (1.0 + 1e-6),
                    "{angle} {bounds:?}"
                );
                widest = widest.max(angle);
            }
            assert!(bounds.theta_o < 1.5 * widest, "{widest} {bounds:?}");
        }
    }
}
