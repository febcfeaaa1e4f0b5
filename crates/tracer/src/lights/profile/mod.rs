//! Distribution of a lamp's intensity over directions.
//!
//! # Contract
//! A [`Profile`] is a function of the unit direction away from the lamp, in the lamp's own frame (x forward, y left, z up). Its owner defines its
//! unit: a factor, or candela. It is finite and never negative, and provides
//! - [`Profile::value`]: the function,
//! - [`Profile::flux_sr`]: its integral over all directions, sr times the unit of the value,
//! - [`Profile::peak`] and [`Profile::on_axis`]: its maximum, and its value along its [`Profile::axis`],
//! - its [`DirectionalExtent`], for the selection of lamps.
//!
//! A profile belongs to directions in space: a mask shapes the light in the whole volume that it crosses.

mod cone;
mod mask_image;
mod photometric_grid;
mod spread;

#[cfg(test)]
mod tests;

use glam::Vec3;

use spread::{ProfileNode, cap};

pub use cone::{Cone, ConeError};
pub use mask_image::{MaskImage, MaskImageError};
pub use photometric_grid::{PhotometricAxes, PhotometricGrid, PhotometricGridError};

pub(in crate::lights) use spread::DirectionalExtent;

/// Distribution of a lamp's intensity.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// 1 in every direction.
    Isotropic,
    /// A spot about +x.
    Cone(Cone),
    /// A measured grid.
    PhotometricGrid(PhotometricGrid),
    /// An image, projected along +x.
    MaskImage(MaskImage),
    /// One profile seen through another: their product.
    Masked(MaskedProfile),
}

/// The product of two profiles. Its integrals are taken over the directions of the narrower one, or of the `mask` if both are equally wide.
#[derive(Clone, Debug, PartialEq)]
pub struct MaskedProfile {
    lamp: Box<Profile>,
    mask: Box<Profile>,
    spread: DirectionalExtent,
}

impl Profile {
    /// `lamp` seen through `mask`.
    #[must_use]
    pub fn masked(lamp: Self, mask: Self) -> Self {
        let spread = DirectionalExtent::from_nodes(&product(&lamp, &mask));
        Self::Masked(MaskedProfile { lamp: Box::new(lamp), mask: Box::new(mask), spread })
    }

    /// The value along the unit `direction` of the lamp's frame, away from the lamp.
    #[must_use]
    pub fn value(&self, direction: Vec3) -> f32 {
        match self {
            Self::Isotropic => 1.0,
            Self::Cone(cone) => cone.value(direction),
            Self::PhotometricGrid(grid) => grid.value(direction),
            Self::MaskImage(image) => image.value(direction),
            Self::Masked(masked) => masked.mask.value(direction) * masked.lamp.value(direction),
        }
    }

    /// ∫ value dΩ over all directions.
    #[must_use]
    pub fn flux_sr(&self) -> f64 {
        self.spread().flux_sr
    }

    /// Maximum value. For a masked profile, over the directions of its integrals.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.spread().peak
    }

    /// The profile's axis: straight down for a grid of type C, forward for all others.
    #[must_use]
    pub fn axis(&self) -> Vec3 {
        match self {
            Self::PhotometricGrid(grid) if grid.axes() == PhotometricAxes::C => Vec3::NEG_Z,
            Self::Masked(masked) => masked.lamp.axis(),
            _ => Vec3::X,
        }
    }

    /// The value along [`Profile::axis`].
    #[must_use]
    pub fn on_axis(&self) -> f64 {
        f64::from(self.value(self.axis()))
    }

    pub(in crate::lights) fn spread(&self) -> &DirectionalExtent {
        match self {
            Self::Isotropic => &DirectionalExtent::EVERYWHERE,
            Self::Cone(cone) => cone.spread(),
            Self::PhotometricGrid(grid) => grid.spread(),
            Self::MaskImage(image) => image.spread(),
            Self::Masked(masked) => &masked.spread,
        }
    }
}

/// The nodes of the narrower profile, their values times those of the other. They are thus dense enough for a narrow spot behind a wide
/// mask.
fn product(lamp: &Profile, mask: &Profile) -> Vec<ProfileNode> {
    let narrower = lamp.spread().reach_rad < mask.spread().reach_rad;
    let (of, factor) = if narrower { (lamp, mask) } else { (mask, lamp) };
    let mut nodes = nodes(of);
    nodes.iter_mut().for_each(|n| n.value *= factor.value(n.direction));
    nodes
}

fn nodes(profile: &Profile) -> Vec<ProfileNode> {
    match profile {
        Profile::Isotropic => cap(2.0, |_| 1.0),
        Profile::Cone(cone) => cone.nodes(),
        Profile::PhotometricGrid(grid) => grid.nodes(),
        Profile::MaskImage(image) => image.nodes(),
        Profile::Masked(masked) => product(&masked.lamp, &masked.mask),
    }
}
