//! Writing spectral images.
//!
//! Each channel `S0.<centre>nm` holds the **mean over its band** per nm, as the cube does. `etendue:units` states the
//! true unit; `emissiveUnits` is the literal string that readers of the layout expect. R, G, B are a preview in linear
//! sRGB whose luminance is in cd/m² (lx for irradiance): it is of no use for measurement.

use etendue_core::quantity::{Length, Quantity, Radiance, Variance};
use etendue_core::{Plane, SpectralCube};

use super::encode::{EncodeError, ExrImage};
use super::name::{Stokes, channel_name};
use super::preview::linear_srgb;
use crate::Provenance;

/// The channel of distances along pixels' rays.
pub(super) const DISTANCE: &str = "distance.Z";
/// The channel of distances along the camera's axis.
const DEPTH: &str = "depth.Z";

/// The version of the layout that we write.
const LAYOUT_VERSION: &str = "1.0";

/// How far off the scene is in each pixel of a radiance image, m; +∞ the sky, NaN no ray.
#[derive(Clone, Copy, Debug)]
pub struct Lengths<'a> {
    /// Along the pixel's ray.
    pub distance: &'a Plane<Length>,
    /// Along the camera's axis.
    pub depth: &'a Plane<Length>,
}

/// A spectral image, with the variance of its band means where given (its unit is the square of the cube's).
pub fn encode_spectral<Q: Quantity<Sample = f32>>(
    cube: &SpectralCube<Q>,
    variance: Option<&SpectralCube<Variance>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    spectral_image(cube, variance, provenance).into_bytes()
}

/// A radiance image, with the distances of what its pixels see where given, in channels `distance.Z` and `depth.Z`.
pub fn encode_radiance(
    cube: &SpectralCube<Radiance>,
    variance: Option<&SpectralCube<Variance>>,
    lengths: Option<Lengths<'_>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    let mut image = spectral_image(cube, variance, provenance);
    if let Some(Lengths { distance, depth }) = lengths {
        image.float(DISTANCE, distance.samples().to_vec());
        image.float(DEPTH, depth.samples().to_vec());
        image.state("lengths", "distance.Z along the pixel's ray, depth.Z along the axis: m; +inf: sky; NaN: no ray");
    }
    image.into_bytes()
}

fn spectral_image<Q: Quantity<Sample = f32>>(
    cube: &SpectralCube<Q>,
    variance: Option<&SpectralCube<Variance>>,
    provenance: &Provenance,
) -> ExrImage {
    let mut image = ExrImage::new(cube.width(), cube.height(), provenance);
    add_bands(&mut image, cube, false);
    if let Some(variance) = variance {
        add_bands(&mut image, variance, true);
        image.state("variance", "variance of each band mean, squared units, in channels variance.S0");
    }
    for (name, plane) in ["R", "G", "B"].into_iter().zip(linear_srgb(cube)) {
        image.float(name, plane);
    }
    state_layout::<Q>(&mut image, cube.bands().width_nm());
    image
}

fn add_bands<Q: Quantity<Sample = f32>>(image: &mut ExrImage, cube: &SpectralCube<Q>, variance: bool) {
    for (i, plane) in cube.planes().iter().enumerate() {
        let name = channel_name(Stokes::Emissive(0), cube.bands().centre_nm(i), variance);
        image.float(name, plane.samples().to_vec());
    }
}

fn state_layout<Q: Quantity>(image: &mut ExrImage, band_width_nm: f64) {
    image.state("quantity", Q::NAME);
    image.state("units", Q::UNIT);
    image.state("preview", "R, G, B: linear sRGB, (1, 1, 1) is 1 cd.m^-2 (lx for irradiance), for display only");
    image.state("band_width_nm", band_width_nm.to_string());
    image.facts.insert("spectralLayoutVersion".to_owned(), LAYOUT_VERSION.to_owned());
    image.facts.insert("emissiveUnits".to_owned(), layout_unit(Q::UNIT).to_owned());
    image.white_luminance = Some(1.0);
}

/// The unit as readers of the layout expect it: without `nm^-1`, although the values are per nm.
fn layout_unit(unit: &str) -> &str {
    unit.strip_suffix(".nm^-1").unwrap_or(unit)
}
