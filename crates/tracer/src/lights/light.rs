//! A light in the scene: the closed list.

use super::lamp::LampLight;
use super::opening::OpeningLight;
use super::sphere::SphereLight;
use super::triangle::TriangleLight;

/// A light in the scene.
#[derive(Clone, Debug)]
pub(super) enum Light {
    Triangle(TriangleLight),
    Sphere(SphereLight),
    Lamp(LampLight),
    Opening(OpeningLight),
}

impl Light {
    pub(super) fn triangles(&self) -> usize {
        if let Self::Triangle(light) = self { light.triangles() } else { 0 }
    }
}
