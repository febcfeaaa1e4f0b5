//! Writing spectral images, with their colour preview.
//!
//! Each channel `S0.<centre>nm` holds the **mean over its band** per nm, as the cube does. `etendue:units` states the true unit; `emissiveUnits` is the literal
//! string that readers of the layout expect. R, G, B are a preview in linear sRGB whose luminance is in cd/m² (lx for irradiance): it is not suited for
//! measurement.

use std::ops::Range;

use etendue_core::quantity::{Length, Quantity, Radiance, Variance};
use etendue_core::{Bands, Plane, SpectralCube, StoredCube, storage::BandReader};
use etendue_spectra::{colour::linear_srgb_from_xyz, observer::xyz_weights};

use super::channel::{ChannelSource, EncodeError, SampleRows, Strips};
use super::colour_space::{Stokes, channel_name};
use super::encode::ExrImage;
use crate::Provenance;

/// The channel of distances along pixels' rays.
pub(super) const DISTANCE: &str = "distance.Z";
/// The channel of distances along the camera's axis.
const DEPTH: &str = "depth.Z";

/// Version of the layout that is written.
const LAYOUT_VERSION: &str = "1.0";

/// Distance of the scene in each pixel of a radiance image, m; +∞ for sky, NaN without a ray.
#[derive(Clone, Copy, Debug)]
pub struct LengthPlanes<'a> {
    /// Along the pixel's ray.
    pub distance: &'a Plane<Length>,
    /// Along the camera's axis.
    pub depth: &'a Plane<Length>,
}

/// Bands of a spectral image, in memory or on the disk.
#[derive(Clone, Copy, Debug)]
pub struct SpectralBands<'a> {
    /// Wavelength bands.
    pub bands: Bands,
    /// Columns and rows.
    pub size: (usize, usize),
    /// Band means.
    pub mean: &'a dyn BandReader,
    /// Variances of the means, squared units; `None` if they are not stored.
    pub variance: Option<&'a dyn BandReader>,
}

impl<'a> SpectralBands<'a> {
    /// Bands of cubes in memory.
    #[must_use]
    pub fn from_cubes<Q: Quantity<Sample = f32>>(
        cube: &'a SpectralCube<Q>,
        variance: Option<&'a SpectralCube<Variance>>,
    ) -> Self {
        let variance = variance.map(|cube| -> &dyn BandReader { cube });
        Self { bands: cube.bands(), size: (cube.width(), cube.height()), mean: cube, variance }
    }

    /// Bands of cubes in memory or on the disk.
    #[must_use]
    pub fn from_stored<Q: Quantity<Sample = f32>>(
        cube: &'a StoredCube<Q>,
        variance: Option<&'a StoredCube<Variance>>,
    ) -> Self {
        let variance = variance.map(StoredCube::reader);
        Self { bands: cube.bands(), size: (cube.width(), cube.height()), mean: cube.reader(), variance }
    }
}

/// Encodes a spectral image, with the variance of its band means if given (its unit is the square of the cube's).
///
/// # Errors
/// If it cannot be stored.
pub fn encode_spectral<Q: Quantity<Sample = f32>>(
    cube: &SpectralCube<Q>,
    variance: Option<&SpectralCube<Variance>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    spectral_image::<Q>(SpectralBands::from_cubes(cube, variance), provenance).into_bytes()
}

/// Encodes a radiance image, with the scene distances if given, in channels `distance.Z` and `depth.Z`.
///
/// # Errors
/// If it cannot be stored.
pub fn encode_radiance(
    cube: &SpectralCube<Radiance>,
    variance: Option<&SpectralCube<Variance>>,
    lengths: Option<LengthPlanes<'_>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    radiance_image(SpectralBands::from_cubes(cube, variance), lengths, provenance).into_bytes()
}

/// Returns a radiance image for writing.
#[must_use]
pub fn radiance_image<'a>(
    bands: SpectralBands<'a>,
    lengths: Option<LengthPlanes<'a>>,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = spectral_image::<Radiance>(bands, provenance);
    if let Some(LengthPlanes { distance, depth }) = lengths {
        image.float(DISTANCE, distance.samples());
        image.float(DEPTH, depth.samples());
        image.state("lengths", "distance.Z along the pixel's ray, depth.Z along the axis: m; +inf: sky; NaN: no ray");
    }
    image
}

/// Returns a spectral image of a quantity for writing.
#[must_use]
pub fn spectral_image<'a, Q: Quantity<Sample = f32>>(
    bands: SpectralBands<'a>,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let SpectralBands { bands: band_list, size: (width, height), variance, .. } = bands;
    let mut image = ExrImage::new(width, height, provenance);
    let count = band_list.count();
    for band in 0..count {
        let name = |variance| channel_name(Stokes::Emissive(0), band_list.centre_nm(band), variance);
        image.add(name(false), ChannelSource::StripFloat(band));
        if variance.is_some() {
            image.add(name(true), ChannelSource::StripFloat(count + 3 + band));
        }
    }
    for (place, name) in ["R", "G", "B"].into_iter().enumerate() {
        image.add(name, ChannelSource::StripFloat(count + place));
    }
    if variance.is_some() {
        image.state("variance", "variance of each band mean, squared units, in channels variance.S0");
    }
    state_layout::<Q>(&mut image, band_list.width_nm());
    image.strips = Some(Box::new(BandStrips { bands, weights: band_weights(band_list) }));
    image
}

/// Rows of all bands, their preview, and their variances.
struct BandStrips<'a> {
    bands: SpectralBands<'a>,
    /// Weights of the bands in the preview.
    weights: Vec<[f64; 3]>,
}

impl Strips for BandStrips<'_> {
    fn rows(&self, rows: Range<usize>) -> Result<Vec<SampleRows>, String> {
        let SpectralBands { bands, size: (width, _), mean, variance } = self.bands;
        let read = |reader: &dyn BandReader, band| {
            let mut samples = vec![0.0; width * rows.len()];
            reader.read(band, rows.clone(), &mut samples).map(|()| samples)
        };
        let means = (0..bands.count()).map(|band| read(mean, band)).collect::<Result<Vec<_>, String>>()?;
        let preview = linear_srgb_of_bands(&means.iter().map(Vec::as_slice).collect::<Vec<_>>(), &self.weights);
        let variances = variance.map(|variance| (0..bands.count()).map(move |band| read(variance, band)));
        let variances = variances.into_iter().flatten().collect::<Result<Vec<_>, String>>()?;
        Ok(means.into_iter().chain(preview).chain(variances).map(SampleRows::Float).collect())
    }
}

fn state_layout<Q: Quantity>(image: &mut ExrImage<'_>, band_width_nm: f64) {
    image.state("quantity", Q::NAME);
    image.state("units", Q::UNIT);
    image.state("preview", "R, G, B: linear sRGB, (1, 1, 1) is 1 cd.m^-2 (lx for irradiance), for display only");
    image.state("band_width_nm", band_width_nm.to_string());
    image.facts.insert("spectralLayoutVersion".to_owned(), LAYOUT_VERSION.to_owned());
    image.facts.insert("emissiveUnits".to_owned(), layout_unit(Q::UNIT).to_owned());
    image.white_luminance = Some(1.0);
}

/// Unit in the form that readers of the layout expect: without `nm^-1`, although the values are per nm.
fn layout_unit(unit: &str) -> &str {
    unit.strip_suffix(".nm^-1").unwrap_or(unit)
}

/// Linear sRGB planes of `cube`, (1, 1, 1) at a luminance of 1 cd/m² (1 lx for irradiance). Components may be negative: spectral colours lie outside sRGB.
/// Bands outside the visible range contribute nothing.
pub(crate) fn linear_srgb<Q: Quantity<Sample = f32>>(cube: &SpectralCube<Q>) -> [Vec<f32>; 3] {
    let planes: Vec<&[f32]> = cube.planes().iter().map(Plane::samples).collect();
    linear_srgb_of_bands(&planes, &band_weights(cube.bands()))
}

/// Contribution of a band mean of 1 to linear red, green and blue, (1, 1, 1) at 1 cd/m² of radiance (1 lx of irradiance).
#[must_use]
pub fn band_weights(bands: Bands) -> Vec<[f64; 3]> {
    xyz_weights(bands).into_iter().map(linear_srgb_from_xyz).collect()
}

/// Linear sRGB of the pixels of all bands, by the weights of the bands.
fn linear_srgb_of_bands(bands: &[&[f32]], weights: &[[f64; 3]]) -> [Vec<f32>; 3] {
    let pixels = bands.first().map_or(0, |band| band.len());
    std::array::from_fn(|channel| {
        let mut sums = vec![0.0_f64; pixels];
        for (band, weight) in bands.iter().zip(weights) {
            for (sum, mean) in sums.iter_mut().zip(*band) {
                *sum += weight[channel] * f64::from(*mean);
            }
        }
        sums.into_iter().map(single).collect()
    })
}

/// 32-bit float; every NaN becomes the same one, since processors differ in the bits of theirs.
fn single(value: f64) -> f32 {
    if value.is_nan() { f32::NAN } else { value as f32 }
}

#[cfg(test)]
mod tests {
    use etendue_core::quantity::Radiance;
    use etendue_spectra::{illuminant, observer};

    use super::*;

    #[test]
    fn daylight_of_one_candela_is_white_one() {
        let bands = Bands::covering(380.0, 780.0, 5.0).expect("80 bands");
        let relative = illuminant::by_name("D65").expect("D65");
        let daylight = observer::with_luminance(relative, 1.0).expect("visible");
        let planes = daylight.band_means(bands).into_iter().map(|v| Plane::filled(1, 1, v as f32)).collect();
        let cube = SpectralCube::<Radiance>::from_planes(bands, planes).expect("one plane per band");
        for channel in linear_srgb(&cube) {
            // Products of 5 nm means differ from means of products: CIE 15 tables agree to about 1e-3 at 5 nm.
            assert!((channel[0] - 1.0).abs() < 2e-3, "{}", channel[0]);
        }
    }
}
