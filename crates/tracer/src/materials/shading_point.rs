//! Where textures and spectra of a model are evaluated.

use etendue_core::{Spectral, Wavelengths};

use super::factor::Factor;
use super::reflectance::Reflectance;
use crate::textures::{ImageTexture, Lookup};

/// A point of a surface, and the wavelengths of the path that hit it.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadingPoint<'p, const N: usize> {
    /// All textures, by their ids.
    pub(super) textures: &'p [ImageTexture],
    /// Where textures are read, and how wide.
    pub(super) lookup: &'p Lookup,
    /// Whether the viewer is on the side that the geometric normal points to: the outside of a solid.
    pub(super) front: bool,
    /// Wavelengths of the path, nm.
    pub(super) wavelengths: &'p Wavelengths<N>,
    /// The least roughness α that micro-facets have here: 0 where they are as they are.
    pub(super) least_alpha: f32,
}

impl<const N: usize> ShadingPoint<'_, N> {
    /// A reflectance here, 0 to 1.
    #[inline(always)]
    pub(super) fn reflectance(&self, reflectance: &Reflectance) -> Spectral<N> {
        reflectance.at(self.textures, self.lookup, self.wavelengths)
    }

    /// The roughness α of micro-facets here that have `alpha` by themselves.
    #[inline(always)]
    pub(super) fn widened(&self, alpha: f32) -> f32 {
        alpha.max(self.least_alpha)
    }

    /// A number over the surface here, 0 to 1.
    #[inline(always)]
    pub(super) fn factor(&self, factor: Factor) -> f32 {
        factor.at(self.textures, self.lookup)
    }
}
