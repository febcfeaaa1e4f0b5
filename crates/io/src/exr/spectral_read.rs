//! Reader of spectral images: our own and those of other writers of the layout.
//!
//! A file of ours states its quantity, unit and band width; a file of another writer is read as spectral radiance per nm if `emissiveUnits` states it or is
//! absent, and its evenly spaced wavelengths as band centres. Other content (uneven wavelengths, reflectances, an unknown unit) is refused; ignored content
//! (polarisation) is noted.

use std::{collections::BTreeMap, path::Path};

use etendue_core::quantity::{Irradiance, Length, Quantity, Radiance, Variance};
use etendue_core::{Bands, Plane, SpectralCube};

use super::colour_space::{SpectralChannel, Stokes, parse_channel_name};
use super::read::{ExrFile, read_exr};
use super::spectral::DISTANCE;
use crate::{Error, Provenance};

/// Cube, and the variance of its band means if the file has one.
#[derive(Clone, Debug, PartialEq)]
pub struct CubeWithVariance<Q: Quantity> {
    /// Band means.
    pub cube: SpectralCube<Q>,
    /// Variance of each band mean, squared units.
    pub variance: Option<SpectralCube<Variance>>,
}

/// Spectral image by its quantity.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectralImage {
    /// Spectral radiance, W·m⁻²·sr⁻¹·nm⁻¹.
    Radiance(CubeWithVariance<Radiance>),
    /// Spectral irradiance, W·m⁻²·nm⁻¹.
    Irradiance(CubeWithVariance<Irradiance>),
}

/// Spectral file: values and facts.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectralFile {
    /// Values.
    pub image: SpectralImage,
    /// Distance (m) of the scene along the ray of each pixel, if the file states it.
    pub distance: Option<Plane<Length>>,
    /// Provenance from the header; `None` in a file of another writer.
    pub provenance: Option<Provenance>,
    /// Assumptions and ignored content, in words.
    pub notes: Vec<String>,
}

/// Reads a spectral EXR.
pub fn read_spectral(file: &Path) -> Result<SpectralFile, Error> {
    spectral_of(file, &read_exr(file)?)
}

/// Returns the spectral image in `exr`, which was read from `file`.
///
/// # Errors
/// If it has no emission in evenly spaced bands, or states another unit.
pub fn spectral_of(file: &Path, exr: &ExrFile) -> Result<SpectralFile, Error> {
    let mut notes = Vec::new();
    let image = match stated_quantity(file, exr, &mut notes)? {
        name if name == Irradiance::NAME => SpectralImage::Irradiance(cubes(file, exr, &mut notes)?),
        _ => SpectralImage::Radiance(cubes(file, exr, &mut notes)?),
    };
    let provenance = exr.attributes.contains_key("etendue:plan_hash").then(|| Provenance::from_texts(&own_facts(exr)));
    let distance = exr.channels.iter().find(|channel| channel.name == DISTANCE);
    let distance = distance.and_then(|c| Plane::from_samples(exr.width, exr.height, c.samples.to_floats()));
    Ok(SpectralFile { image, distance, provenance, notes })
}

/// Facts that a provenance holds: ours, without those that describe the values.
fn own_facts(exr: &ExrFile) -> BTreeMap<String, String> {
    const VALUE_ATTRIBUTES: [&str; 6] = ["quantity", "units", "band_width_nm", "preview", "variance", "lengths"];
    let ours = exr.attributes.iter().filter_map(|(name, text)| Some((name.strip_prefix("etendue:")?, text)));
    ours.filter(|(name, _)| !VALUE_ATTRIBUTES.contains(name))
        .map(|(name, text)| (name.to_owned(), text.clone()))
        .collect()
}

fn stated_quantity(file: &Path, exr: &ExrFile, notes: &mut Vec<String>) -> Result<&'static str, Error> {
    let known = [(Radiance::NAME, Radiance::UNIT), (Irradiance::NAME, Irradiance::UNIT)];
    if let (Some(quantity), Some(unit)) = (exr.attributes.get("etendue:quantity"), exr.attributes.get("etendue:units"))
    {
        let matching = known.iter().find(|(name, its_unit)| name == quantity && its_unit == unit);
        let message = || {
            format!(
                "contains {quantity} in {unit}; expected {} in {} or {} in {}",
                known[0].0, known[0].1, known[1].0, known[1].1
            )
        };
        return matching.map(|(name, _)| *name).ok_or_else(|| Error::new(file, message()));
    }
    match exr.attributes.get("emissiveUnits").map(|unit| unit.trim_end_matches(".nm^-1")) {
        Some("W.m^-2.sr^-1") => {
            notes.push("written by another program: values are assumed to be in W.m^-2.sr^-1.nm^-1".to_owned());
        }
        Some("W.m^-2") => return Ok(Irradiance::NAME),
        Some(unit) => {
            return Err(Error::new(file, format!("emissiveUnits is `{unit}`; expected W.m^-2.sr^-1 or W.m^-2")));
        }
        None => notes.push("no unit is stated: values are assumed to be in W.m^-2.sr^-1.nm^-1".to_owned()),
    }
    Ok(Radiance::NAME)
}

fn cubes<Q: Quantity<Sample = f32>>(
    file: &Path,
    exr: &ExrFile,
    notes: &mut Vec<String>,
) -> Result<CubeWithVariance<Q>, Error> {
    let all: Vec<(SpectralChannel, usize)> =
        exr.channels.iter().enumerate().filter_map(|(i, c)| Some((parse_channel_name(&c.name)?, i))).collect();
    let passed = all.iter().filter(|(c, _)| matches!(c.stokes, Stokes::Emissive(1..))).count();
    if passed > 0 {
        notes.push(format!("{passed} polarisation channels (S1, S2, S3) are ignored"));
    }
    let Some(cube) = cube(file, exr, &all, false)? else {
        let reflective = all.iter().any(|(c, _)| c.stokes == Stokes::Reflective);
        let what = if reflective { "contains reflectances (T…nm)" } else { "has no spectral channels" };
        return Err(Error::new(file, format!("{what}; expected emission in channels such as S0.550,000000nm")));
    };
    let variance = cube_of_same_bands(file, cube.bands(), self::cube(file, exr, &all, true)?)?;
    Ok(CubeWithVariance { cube, variance })
}

fn cube_of_same_bands(
    file: &Path,
    bands: Bands,
    variance: Option<SpectralCube<Variance>>,
) -> Result<Option<SpectralCube<Variance>>, Error> {
    let problem = "the variance channels and the values have different wavelengths; the file is incomplete";
    match variance {
        Some(cube) if cube.bands() != bands => Err(Error::new(file, problem)),
        other => Ok(other),
    }
}

fn cube<Q: Quantity<Sample = f32>>(
    file: &Path,
    exr: &ExrFile,
    all: &[(SpectralChannel, usize)],
    variance: bool,
) -> Result<Option<SpectralCube<Q>>, Error> {
    let mut mine: Vec<(f64, usize)> = all
        .iter()
        .filter(|(c, _)| c.stokes == Stokes::Emissive(0) && c.variance == variance)
        .map(|(c, i)| (c.nm, *i))
        .collect();
    mine.sort_by(|a, b| a.0.total_cmp(&b.0));
    if mine.is_empty() {
        return Ok(None);
    }
    let centres: Vec<f64> = mine.iter().map(|(nm, _)| *nm).collect();
    let stated = exr.attributes.get("etendue:band_width_nm").and_then(|text| text.parse().ok());
    let bands = bands_of(&centres, stated).map_err(|problem| Error::new(file, problem))?;
    let planes = mine
        .iter()
        .filter_map(|(_, i)| Plane::from_samples(exr.width, exr.height, exr.channels[*i].samples.to_floats()));
    Ok(SpectralCube::from_planes(bands, planes.collect()))
}

/// Adjoining bands about evenly spaced `centres_nm` (sorted). Names hold six decimals, so centres are known to 1e-6 nm.
fn bands_of(centres_nm: &[f64], stated_width_nm: Option<f64>) -> Result<Bands, String> {
    let count = centres_nm.len();
    let (first, last) = (centres_nm[0], centres_nm[count - 1]);
    let spacing = if count > 1 { Some((last - first) / (count - 1) as f64) } else { None };
    let width = stated_width_nm
        .or(spacing)
        .ok_or("has one wavelength and states no band width; expected the attribute etendue:band_width_nm")?;
    for (i, nm) in centres_nm.iter().enumerate() {
        let even = first + width * i as f64;
        if (nm - even).abs() > 1e-3 * width {
            return Err(format!(
                "wavelengths are not evenly spaced by {width} nm (found {nm} nm instead of {even} nm); resample the file"
            ));
        }
    }
    Bands::new(first - 0.5 * width, width, count).ok_or_else(|| {
        format!("the bands of wavelengths {first} to {last} nm exceed the range of 300 to 1100 nm; crop the file to it")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_stand_about_their_centres() {
        let bands = bands_of(&[382.5, 387.5, 392.5], None).expect("even");
        assert_eq!((bands.low_nm(), bands.width_nm(), bands.count()), (380.0, 5.0, 3));
        assert_eq!(bands_of(&[550.0], Some(10.0)).expect("stated").low_nm(), 545.0);
    }

    #[test]
    fn what_is_no_set_of_bands_is_refused_in_words() {
        let message = bands_of(&[400.0, 410.0, 425.0], None).expect_err("uneven");
        assert!(message.contains("not evenly spaced by 12.5 nm (found 410 nm instead of 412.5 nm)"), "{message}");
        assert!(bands_of(&[550.0], None).is_err());
        assert!(bands_of(&[100.0, 200.0], None).expect_err("range").contains("300 to 1100 nm"));
    }
}
