//! A light in the scene: the closed list.

use super::carried::CarriedLamp;
use super::lamp::LampLight;
use super::moving::MovingLight;
use super::opening_light::OpeningLight;
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
    Carried(Box<CarriedLamp>),
}

impl Light {
    pub(super) fn is_sphere(&self) -> bool {
        match self {
            Self::Sphere(_) => true,
            Self::Moving(light) => light.triangles() == 0,
            _ => false,
        }
    }

    /// Whether it is a lamp without an opening.
    pub(super) fn is_point(&self) -> bool {
        match self {
            Self::Lamp(_) => true,
            Self::Carried(lamp) => !lamp.is_open(),
            _ => false,
        }
    }

    /// Whether it is a lamp with an opening.
    pub(super) fn is_open(&self) -> bool {
        match self {
            Self::Opening(_) => true,
            Self::Carried(lamp) => lamp.is_open(),
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
