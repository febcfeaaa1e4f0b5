//! A light in the scene: the closed list.

use super::moving::{MovingLamp, MovingLight};
use super::{lamp::LampLight, opening_light::OpeningLight, sphere::SphereLight, triangle::TriangleLight};

/// A light in the scene.
#[derive(Clone, Debug)]
pub(super) enum Light {
    Triangle(TriangleLight),
    Sphere(SphereLight),
    Lamp(LampLight),
    Opening(OpeningLight),
    Moving(Box<MovingLight>),
    MovingLamp(Box<MovingLamp>),
}

impl Light {
    pub(super) fn is_sphere(&self) -> bool {
        match self {
            Self::Sphere(_) => true,
            Self::Moving(light) => light.triangles() == 0,
            _ => false,
        }
    }

    /// True for a lamp without an opening.
    pub(super) fn is_point(&self) -> bool {
        match self {
            Self::Lamp(_) => true,
            Self::MovingLamp(lamp) => !lamp.is_open(),
            _ => false,
        }
    }

    /// True for a lamp with an opening.
    pub(super) fn is_open(&self) -> bool {
        match self {
            Self::Opening(_) => true,
            Self::MovingLamp(lamp) => lamp.is_open(),
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

const NONE: u32 = u32::MAX;

/// The light of every primitive of the emitting instances.
#[derive(Clone, Debug, Default)]
pub(super) struct Primitives {
    /// For each instance the index of its first primitive in `lights`; `NONE` if it does not emit.
    first: Vec<u32>,
    lights: Vec<u32>,
}

impl Primitives {
    /// Adds the next instance: one entry per primitive, empty if none of them emits.
    pub(super) fn push(&mut self, lights: impl IntoIterator<Item = Option<u32>>) {
        let first = self.lights.len();
        self.lights.extend(lights.into_iter().map(|l| l.unwrap_or(NONE)));
        self.first.push(if self.lights.len() > first { first as u32 } else { NONE });
    }

    /// Makes all `count` primitives of an instance that does not itself emit one light.
    pub(super) fn assign(&mut self, instance: u32, count: usize, light: u32) {
        self.first[instance as usize] = self.lights.len() as u32;
        self.lights.extend(core::iter::repeat_n(light, count));
    }

    pub(super) fn light(&self, instance: u32, primitive: u32) -> Option<usize> {
        let first = self.first[instance as usize];
        if first == NONE {
            return None;
        }
        let light = self.lights[(first + primitive) as usize];
        (light != NONE).then_some(light as usize)
    }
}
