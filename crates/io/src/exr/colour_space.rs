//! Colour space of an EXR: conversion of R, G and B from its `chromaticities` to Rec. 709.
//!
//! A file without the attribute has Rec. 709 primaries and white, as the format specifies. Only channels named exactly R, G and B are colours; those of layers
//! may be anything (identities, normals) and are unchanged. White is not adapted. Images keep the stored values together with the matrix: a texture of data is
//! no colour.
//!
//! Channel names of the spectral layout.
//!
//! Fichet, Pacanowski, Wilkie, "An OpenEXR layout for spectral images", JCGT 10(3), 2021: `S0.550,000000nm` is the unpolarised emission at 550 nm,
//! `T.550,000000nm` a reflectance or transmittance. The decimal separator is a comma, because a point separates layers. Other writers use a point as well, SI
//! prefixes, and frequencies in Hz.

use core::fmt;
use std::path::Path;

use ::exr::meta::attribute::{Chromaticities, EnvironmentMap};
use etendue_scene::asset::ColourMatrix;
use etendue_spectra::colour::{Primaries, REC_709};

use crate::Error;

/// Tolerance within which chromaticities count as Rec. 709: files round them, and the white point, differently.
const CHROMATICITY_TOLERANCE: f64 = 5e-4;

/// Matrix from these chromaticities to Rec. 709; `None` if they are equal.
pub(crate) fn to_rec_709(file: &Path, stated: &Chromaticities) -> Result<Option<ColourMatrix>, Error> {
    let pair = |v: ::exr::prelude::Vec2<f32>| [f64::from(v.0), f64::from(v.1)];
    let Chromaticities { red, green, blue, white } = *stated;
    let primaries = Primaries { red: pair(red), green: pair(green), blue: pair(blue), white: pair(white) };
    if primaries.is_close_to(&REC_709, CHROMATICITY_TOLERANCE) {
        return Ok(None);
    }
    let matrix = primaries.to_linear_srgb().ok_or_else(|| {
        let what = format!("its chromaticities ({}) do not define a colour space", text(stated));
        Error::new(file, format!("{what}; correct the attribute, or remove it if the colours are Rec. 709"))
    })?;
    Ok(Some(ColourMatrix(matrix)))
}

/// The attribute in words.
pub(super) fn text(Chromaticities { red, green, blue, white }: &Chromaticities) -> String {
    let pair = |v: &::exr::prelude::Vec2<f32>| format!("({}, {})", v.0, v.1);
    format!("red {}, green {}, blue {}, white {}", pair(red), pair(green), pair(blue), pair(white))
}

/// Projection that a file states, in a word; `None` if it states none.
pub(super) fn projection(stated: Option<EnvironmentMap>) -> Option<&'static str> {
    stated.map(|stated| match stated {
        EnvironmentMap::LatitudeLongitude => "latitude-longitude",
        EnvironmentMap::Cube => CUBE,
    })
}

/// Attribute of the projection.
pub(super) const ENVMAP: &str = "envmap";
pub(super) const CUBE: &str = "cube";

/// Speed of light in vacuum, m/s (exact, SI).
const LIGHT_M_PER_S: f64 = 299_792_458.0;

/// Content of a spectral channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Stokes {
    /// A component of the Stokes vector of emitted light; 0 is the intensity.
    Emissive(u8),
    /// Reflectance or transmittance.
    Reflective,
}

/// Parsed channel name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectralChannel {
    /// Content.
    pub stokes: Stokes,
    /// Wavelength in vacuum, nm.
    pub nm: f64,
    /// True if the name states a wavelength, not a frequency.
    pub by_wavelength: bool,
    /// True if it is our variance of that channel.
    pub variance: bool,
}

/// Layer of our variance channels, with its dot.
const VARIANCE: &str = "variance.";

impl fmt::Display for Stokes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Emissive(component) => write!(f, "S{component}"),
            Self::Reflective => f.write_str("T"),
        }
    }
}

/// Name of a channel at `nm`, with six decimals.
#[must_use]
pub fn channel_name(stokes: Stokes, nm: f64, variance: bool) -> String {
    let number = format!("{nm:.6}").replace('.', ",");
    format!("{}{stokes}.{number}nm", if variance { VARIANCE } else { "" })
}

/// Parses a channel name; `None` if it is no spectral channel.
#[must_use]
pub fn parse_channel_name(name: &str) -> Option<SpectralChannel> {
    let bare = name.strip_prefix(VARIANCE);
    let (layer, value) = bare.unwrap_or(name).split_once('.')?;
    let stokes = parse_stokes(layer)?;
    let (nm, by_wavelength) = parse_wavelength(value)?;
    Some(SpectralChannel { stokes, nm, by_wavelength, variance: bare.is_some() })
}

fn parse_stokes(layer: &str) -> Option<Stokes> {
    match layer {
        "T" => Some(Stokes::Reflective),
        _ => layer.strip_prefix('S')?.parse().ok().filter(|&c| c < 4).map(Stokes::Emissive),
    }
}

/// Wavelength in vacuum, nm, and true if it was stated as a wavelength.
fn parse_wavelength(text: &str) -> Option<(f64, bool)> {
    let (rest, by_wavelength) = match text.strip_suffix("Hz") {
        Some(rest) => (rest, false),
        None => (text.strip_suffix('m')?, true),
    };
    let digits = rest.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let scale = prefix_scale(&rest[digits.len()..])?;
    let value: f64 = digits.replace(',', ".").parse().ok().filter(|v: &f64| v.is_finite() && *v > 0.0)?;
    let nm = if by_wavelength { value * (scale * 1e9) } else { LIGHT_M_PER_S / (value * scale) * 1e9 };
    Some((nm, by_wavelength))
}

fn prefix_scale(prefix: &str) -> Option<f64> {
    Some(match prefix {
        "" => 1.0,
        "k" => 1e3,
        "M" => 1e6,
        "G" => 1e9,
        "T" => 1e12,
        "P" => 1e15,
        "c" => 1e-2,
        "m" => 1e-3,
        "u" => 1e-6,
        "n" => 1e-9,
        "p" => 1e-12,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use ::exr::prelude::{
        AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Vec2, WritableImage as _,
    };

    use super::super::decode_exr;
    use super::*;

    /// One pixel of channels with values.
    fn file(
        values: &[(&str, f32)],
        chromaticities: Option<Chromaticities>,
        projection: Option<EnvironmentMap>,
    ) -> Vec<u8> {
        let channels = values.iter().map(|(name, value)| AnyChannel::new(*name, FlatSamples::F32(vec![*value])));
        let mut attributes = LayerAttributes::named("");
        attributes.layer_name = None;
        attributes.environment_map = projection;
        let layer = Layer::new((1, 1), attributes, Encoding::UNCOMPRESSED, AnyChannels::sort(channels.collect()));
        let mut image = Image::from_layer(layer);
        image.attributes.chromaticities = chromaticities;
        let mut bytes = Cursor::new(Vec::new());
        image.write().to_buffered(&mut bytes).expect("written");
        bytes.into_inner()
    }

    fn space([red, green, blue, white]: [[f32; 2]; 4]) -> Option<Chromaticities> {
        let point = |[x, y]: [f32; 2]| Vec2(x, y);
        Some(Chromaticities { red: point(red), green: point(green), blue: point(blue), white: point(white) })
    }

    fn values(bytes: &[u8]) -> Vec<(String, f32)> {
        let read = decode_exr(Path::new("a.exr"), bytes).expect("readable");
        read.channels.into_iter().map(|channel| (channel.name, channel.samples.into_floats()[0])).collect()
    }

    const XYZ: [[f32; 2]; 4] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1.0 / 3.0, 1.0 / 3.0]];

    /// XYZ of linear Rec. 709 (0.6, 0.2, 0.1).
    const STORED: [(&str, f32); 5] =
        [("A", 0.5), ("B", 0.130_490_66), ("G", 0.277_836_38), ("N.R", 1.0), ("R", 0.336_999_42)];

    #[test]
    fn colours_of_other_primaries_become_those_of_rec_709() {
        let actual = values(&file(&STORED, space(XYZ), None));
        for ((name, value), expected) in actual.iter().zip([0.5, 0.1, 0.2, 1.0, 0.6]) {
            // The standard's white and that of the tables differ by 3e-4.
            assert!((value - expected).abs() < 5e-4, "{name}: {value} for {expected}");
        }
        let as_stored: Vec<(String, f32)> = STORED.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect();
        assert_eq!(values(&file(&STORED, None, None)), as_stored);
        let rec_709 = space([[0.64, 0.33], [0.3, 0.6], [0.15, 0.06], [0.3127, 0.329]]);
        assert_eq!(values(&file(&STORED, rec_709, None)), as_stored);
        let grey = [("Y", 0.25)];
        assert_eq!(values(&file(&grey, space(XYZ), None)), [("Y".to_owned(), 0.25)]);
    }

    #[test]
    fn the_conversion_is_stated_and_what_is_no_space_refused() {
        let read = decode_exr(Path::new("a.exr"), &file(&STORED, space(XYZ), None)).expect("readable");
        assert!(
            read.attributes["chromaticities"].ends_with("R, G and B are converted to Rec. 709"),
            "{:?}",
            read.attributes
        );
        let line = space([[0.6, 0.3], [0.4, 0.3], [0.2, 0.3], [0.3, 0.3]]);
        let message = decode_exr(Path::new("a.exr"), &file(&STORED, line, None)).expect_err("no space").to_string();
        assert!(
            message.starts_with("a.exr: its chromaticities (red (0.6, 0.3)")
                && message.contains("correct the attribute"),
            "{message}"
        );
    }

    #[test]
    fn an_image_keeps_the_stored_values_and_the_matrix() {
        let image =
            crate::picture::decode_image(Path::new("a.exr"), &file(&STORED, space(XYZ), None)).expect("readable");
        assert_eq!(
            image.pixels,
            etendue_scene::asset::ImagePixels::Rgba32F(vec![[STORED[4].1, STORED[2].1, STORED[1].1, 0.5]])
        );
        let etendue_scene::asset::ImagePixels::Rgba32F(colours) = image.in_rec_709().pixels else { panic!("colours") };
        let [r, g, b, a] = colours[0];
        assert!((r - 0.6).abs() < 5e-4 && (g - 0.2).abs() < 5e-4 && (b - 0.1).abs() < 5e-4 && a == 0.5, "{colours:?}");
    }

    #[test]
    fn a_cube_map_is_no_picture() {
        let read = |projection| decode_exr(Path::new("a.exr"), &file(&STORED, None, projection)).expect("readable");
        let message = read(Some(EnvironmentMap::Cube)).check_is_no_cube_map(Path::new("a.exr")).expect_err("a cube");
        assert!(message.to_string().starts_with("a.exr: a cube map"), "{message}");
        for projection in [None, Some(EnvironmentMap::LatitudeLongitude)] {
            assert!(read(projection).check_is_no_cube_map(Path::new("a.exr")).is_ok());
        }
        let cube = file(&STORED, None, Some(EnvironmentMap::Cube));
        assert!(crate::picture::decode_image(Path::new("a.exr"), &cube).is_err());
        assert!(crate::photograph::decode_photograph(Path::new("a.exr"), &cube).is_err());
    }

    fn nm(name: &str) -> Option<f64> {
        parse_channel_name(name).map(|c| c.nm)
    }

    #[test]
    fn our_names_are_those_of_the_paper() {
        assert_eq!(channel_name(Stokes::Emissive(0), 550.0, false), "S0.550,000000nm");
        assert_eq!(channel_name(Stokes::Reflective, 382.5, false), "T.382,500000nm");
        assert_eq!(channel_name(Stokes::Emissive(0), 550.0, true), "variance.S0.550,000000nm");
    }

    #[test]
    fn names_of_other_writers_are_understood() {
        assert_eq!(nm("S0.550nm"), Some(550.0));
        assert_eq!(nm("S0.550.25nm"), Some(550.25));
        // Scaling by 1e3 and 1e9 rounds once or twice: at most 4 units in the last place.
        for name in ["S0.0,55um", "S0.5,5E-7m", "S0.545077,19636363636GHz", "S0.545.07719636363636THz"] {
            let parsed = nm(name).expect(name);
            assert!((parsed - 550.0).abs() < 550.0 * 1e-9, "{name}: {parsed}");
        }
        assert_eq!(parse_channel_name("S2.550nm").map(|c| c.stokes), Some(Stokes::Emissive(2)));
    }

    #[test]
    fn other_channels_are_left_alone() {
        for name in ["R", "N.X", "S0.Y", "S4.550nm", "S0.-5nm", "S0.nm", "S0.550", "T.0nm", "S0.infnm", "depth.Z"] {
            assert_eq!(parse_channel_name(name), None, "{name}");
        }
    }

    proptest::proptest! {
        #[test]
        fn a_name_reads_back_to_its_wavelength(stored in 300_000_000_u32..1_100_000_000) {
            let stored_nm = f64::from(stored) * 1e-6;
            let back = parse_channel_name(&channel_name(Stokes::Emissive(0), stored_nm, true)).expect("our own name");
            // Six decimals are written: half a unit of the last.
            proptest::prop_assert!(back.variance && (back.nm - stored_nm).abs() <= 0.5e-6);
        }
    }
}
