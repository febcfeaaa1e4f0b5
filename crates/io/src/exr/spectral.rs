//! Writing spectral images.
//!
//! Each channel `S0.<centre>nm` holds the **mean over its band** per nm, as the cube does. `etendue:units` states the
//! true unit; `emissiveUnits` is the literal string that readers of the layout expect. R, G, B are a preview in linear
//! sRGB whose luminance is in cd/m² (lx for irradiance): it is of no use for measurement.

use std::ops::Range;

use etendue_core::quantity::{Length, Quantity, Radiance, Variance};
use etendue_core::storage::BandReader;
use etendue_core::{Bands, KeptCube, Plane, SpectralCube};

use super::channel::{Channel, Samples, Strips};
use super::encode::ExrImage;
use super::encode_error::EncodeError;
use super::name::{Stokes, channel_name};
use super::preview::{band_weights, linear_srgb_of_bands};
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

/// The bands of a spectral image, in memory or on the disk.
#[derive(Clone, Copy, Debug)]
pub struct SpectralBands<'a> {
    /// Which bands.
    pub bands: Bands,
    /// Columns and rows.
    pub size: (usize, usize),
    /// Their means.
    pub mean: &'a dyn BandReader,
    /// The variances of these, squared units; `None` where they are not stored.
    pub variance: Option<&'a dyn BandReader>,
}

impl<'a> SpectralBands<'a> {
    /// Those of cubes in memory.
    #[must_use]
    pub fn of<Q: Quantity<Sample = f32>>(
        cube: &'a SpectralCube<Q>,
        variance: Option<&'a SpectralCube<Variance>>,
    ) -> Self {
        let variance = variance.map(|cube| -> &dyn BandReader { cube });
        Self { bands: cube.bands(), size: (cube.width(), cube.height()), mean: cube, variance }
    }

    /// Those of cubes wherever they are.
    #[must_use]
    pub fn of_kept<Q: Quantity<Sample = f32>>(cube: &'a KeptCube<Q>, variance: Option<&'a KeptCube<Variance>>) -> Self {
        let variance = variance.map(KeptCube::reader);
        Self { bands: cube.bands(), size: (cube.width(), cube.height()), mean: cube.reader(), variance }
    }
}

/// A spectral image, with the variance of its band means where given (its unit is the square of the cube's).
///
/// # Errors
/// Where it cannot be stored.
pub fn encode_spectral<Q: Quantity<Sample = f32>>(
    cube: &SpectralCube<Q>,
    variance: Option<&SpectralCube<Variance>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    spectral_image::<Q>(SpectralBands::of(cube, variance), provenance).into_bytes()
}

/// A radiance image, with the distances of what its pixels see where given, in channels `distance.Z` and `depth.Z`.
///
/// # Errors
/// Where it cannot be stored.
pub fn encode_radiance(
    cube: &SpectralCube<Radiance>,
    variance: Option<&SpectralCube<Variance>>,
    lengths: Option<Lengths<'_>>,
    provenance: &Provenance,
) -> Result<Vec<u8>, EncodeError> {
    radiance_image(SpectralBands::of(cube, variance), lengths, provenance).into_bytes()
}

/// A radiance image, to be written.
#[must_use]
pub fn radiance_image<'a>(
    bands: SpectralBands<'a>,
    lengths: Option<Lengths<'a>>,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let mut image = spectral_image::<Radiance>(bands, provenance);
    if let Some(Lengths { distance, depth }) = lengths {
        image.float(DISTANCE, distance.samples());
        image.float(DEPTH, depth.samples());
        image.state("lengths", "distance.Z along the pixel's ray, depth.Z along the axis: m; +inf: sky; NaN: no ray");
    }
    image
}

/// A spectral image of a quantity, to be written.
#[must_use]
pub fn spectral_image<'a, Q: Quantity<Sample = f32>>(
    bands: SpectralBands<'a>,
    provenance: &Provenance,
) -> ExrImage<'a> {
    let SpectralBands { bands: of, size: (width, height), variance, .. } = bands;
    let mut image = ExrImage::new(width, height, provenance);
    let count = of.count();
    for band in 0..count {
        let name = |variance| channel_name(Stokes::Emissive(0), of.centre_nm(band), variance);
        image.add(name(false), Channel::StripFloat(band));
        if variance.is_some() {
            image.add(name(true), Channel::StripFloat(count + 3 + band));
        }
    }
    for (place, name) in ["R", "G", "B"].into_iter().enumerate() {
        image.add(name, Channel::StripFloat(count + place));
    }
    if variance.is_some() {
        image.state("variance", "variance of each band mean, squared units, in channels variance.S0");
    }
    state_layout::<Q>(&mut image, of.width_nm());
    image.strips = Some(Box::new(BandStrips { bands, weights: band_weights(of) }));
    image
}

/// Rows of all bands, their preview, and their variances.
struct BandStrips<'a> {
    bands: SpectralBands<'a>,
    /// Of the preview.
    weights: Vec<[f64; 3]>,
}

impl Strips for BandStrips<'_> {
    fn rows(&self, rows: Range<usize>) -> Result<Vec<Samples>, String> {
        let SpectralBands { bands, size: (width, _), mean, variance } = self.bands;
        let read = |reader: &dyn BandReader, band| {
            let mut samples = vec![0.0; width * rows.len()];
            reader.read(band, rows.clone(), &mut samples).map(|()| samples)
        };
        let means = (0..bands.count()).map(|band| read(mean, band)).collect::<Result<Vec<_>, String>>()?;
        let preview = linear_srgb_of_bands(&means.iter().map(Vec::as_slice).collect::<Vec<_>>(), &self.weights);
        let variances = variance.map(|variance| (0..bands.count()).map(move |band| read(variance, band)));
        let variances = variances.into_iter().flatten().collect::<Result<Vec<_>, String>>()?;
        Ok(means.into_iter().chain(preview).chain(variances).map(Samples::Float).collect())
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

/// The unit as readers of the layout expect it: without `nm^-1`, although the values are per nm.
fn layout_unit(unit: &str) -> &str {
    unit.strip_suffix(".nm^-1").unwrap_or(unit)
}
