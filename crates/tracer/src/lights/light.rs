//! A light in the scene: the closed list.

use super::lamp::LampLight;
use super::moving::MovingLight;
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
    Moving(Box<MovingLight>),
}

impl Light {
    pub(super) fn is_sphere(&self) -> bool {
        match self {
            Self::Sphere(_) => true,
            Self::Moving(light) => light.triangles() == 0,
            _ => false,
        }
    }

    pub(super) fn triangles(&self) -> usize {
        match self {
            Self::Triangle(light) => light.triangles(),
            Self::Moving(light) => light.triangles(),
            _ => 0,
        }
    }
}
