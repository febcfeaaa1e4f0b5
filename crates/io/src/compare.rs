//! Two results of the same kind, compared channel by channel.

use std::path::Path;

use etendue_scene::asset::ImagePixels;

use crate::exr::{ExrFile, ExrSamples, read_exr};
use crate::{Error, ErrorCode, picture::read_image};

/// Channels of two files of equal size.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedFiles {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels by name. Previews (R, G, B next to spectral bands) and variances are not separate channels.
    pub channels: Vec<ChannelPair>,
    /// Origin of the variances of the first and the second file.
    pub origin: (VarianceOrigin, VarianceOrigin),
}

/// Origin of the variances of a file, from its header; 1 if not stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VarianceOrigin {
    /// Independent replicates.
    pub replicates: u32,
    /// Pixels whose errors may be correlated, because their paths shared samples.
    pub correlated_block_px: u32,
}

impl VarianceOrigin {
    const NONE: Self = Self { replicates: 1, correlated_block_px: 1 };
}

/// Channel present in both files.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelPair {
    pub name: String,
    /// Its samples.
    pub content: PairContent,
}

/// The samples of a channel in the first and in the second file.
#[derive(Clone, Debug, PartialEq)]
pub enum PairContent {
    /// Numbers, and their variances if both files have them.
    Number {
        /// Values of the first file.
        a: Vec<f32>,
        /// Values of the second.
        b: Vec<f32>,
        /// Variances of the means.
        variance: Option<(Vec<f32>, Vec<f32>)>,
    },
    Identity {
        /// Identities of the first file.
        a: Vec<u32>,
        /// Identities of the second.
        b: Vec<u32>,
    },
}

impl ChannelPair {
    /// Returns true if both files state a variance.
    #[must_use]
    pub fn has_variance(&self) -> bool {
        matches!(self.content, PairContent::Number { variance: Some(_), .. })
    }
}

/// Reads two files for comparison: EXR with EXR, image with image.
pub fn read_pair(a: &Path, b: &Path) -> Result<ComparedFiles, Error> {
    let is_exr = |path: &Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"));
    match (is_exr(a), is_exr(b)) {
        (true, true) => compare_exr(b, &read_exr(a)?, &read_exr(b)?),
        (false, false) => compare_images(a, b),
        _ => Err(Error::coded(
            ErrorCode::NotComparable,
            b,
            format!("cannot be compared with {}; give two EXR files or two images", a.display()),
        )),
    }
}

fn compare_exr(path: &Path, a: &ExrFile, b: &ExrFile) -> Result<ComparedFiles, Error> {
    check_size(path, [a.width, a.height], [b.width, b.height])?;
    check_stated(path, a, b)?;
    check_channels(path, &names(a), &names(b))?;
    let channels = names(a).into_iter().filter(|name| !name.starts_with(VARIANCE) && !is_preview(a, name));
    let channels = channels.map(|name| channel(path, a, b, name)).collect::<Result<_, _>>()?;
    Ok(ComparedFiles { width: a.width, height: a.height, channels, origin: (origin(a), origin(b)) })
}

/// Checks that quantity and unit are the same if both files state them.
fn check_stated(path: &Path, a: &ExrFile, b: &ExrFile) -> Result<(), Error> {
    for fact in ["quantity", "units"] {
        let stated = |file: &ExrFile| file.attributes.get(&format!("etendue:{fact}")).cloned();
        if let (Some(of_a), Some(of_b)) = (stated(a), stated(b))
            && of_a != of_b
        {
            let what =
                format!("the {fact} is \"{of_b}\", that of the other file \"{of_a}\"; compare files of the same kind");
            return Err(Error::coded(ErrorCode::NotComparable, path, what));
        }
    }
    Ok(())
}

fn check_channels(path: &Path, of_a: &[&str], of_b: &[&str]) -> Result<(), Error> {
    let lacking = missing_names(of_a, of_b);
    let surplus = missing_names(of_b, of_a);
    let is_variance = |names: &[&str]| names.iter().all(|name| name.starts_with(VARIANCE));
    let what = match (lacking.is_empty(), surplus.is_empty()) {
        (true, true) => return Ok(()),
        (false, true) if is_variance(&lacking) => {
            "has no variances, but the other file has; render both with output.variance, or both without".to_owned()
        }
        (true, false) if is_variance(&surplus) => {
            "has variances, but the other file has none; render both with output.variance, or both without".to_owned()
        }
        (false, true) => {
            format!("lacks channels of the other file: {}; compare files of the same kind", first_names(&lacking))
        }
        (true, false) => {
            format!("has channels that the other file lacks: {}; compare files of the same kind", first_names(&surplus))
        }
        (false, false) => {
            format!(
                "has the channels {} instead of {}; compare files of the same kind",
                first_names(&surplus),
                first_names(&lacking)
            )
        }
    };
    Err(Error::coded(ErrorCode::NotComparable, path, what))
}

/// Names that are not among the others.
fn missing_names<'n>(names: &[&'n str], others: &[&str]) -> Vec<&'n str> {
    names.iter().filter(|name| !others.contains(name)).copied().collect()
}

/// The first names, and the number of the rest.
fn first_names(names: &[&str]) -> String {
    const MAX_NAMES: usize = 4;
    let shown = names[..names.len().min(MAX_NAMES)].join(", ");
    match names.len().saturating_sub(MAX_NAMES) {
        0 => shown,
        more => format!("{shown} and {more} more"),
    }
}

const VARIANCE: &str = "variance.";

fn names(file: &ExrFile) -> Vec<&str> {
    file.channels.iter().map(|c| c.name.as_str()).collect()
}

/// True for R, G and B next to spectral bands, from which they are computed.
fn is_preview(file: &ExrFile, name: &str) -> bool {
    ["R", "G", "B"].contains(&name) && file.channels.iter().any(|c| c.name.starts_with("S0."))
}

fn origin(file: &ExrFile) -> VarianceOrigin {
    let stated = |key| file.attributes.get(key).and_then(|text| text.parse().ok()).unwrap_or(1);
    VarianceOrigin {
        replicates: stated("etendue:replicates"),
        correlated_block_px: stated("etendue:correlated_block_px"),
    }
}

fn channel(path: &Path, a: &ExrFile, b: &ExrFile, name: &str) -> Result<ChannelPair, Error> {
    let both = |name: &str| Some((a.channel(name)?, b.channel(name)?));
    let content = match both(name) {
        Some((ExrSamples::Uint(a), ExrSamples::Uint(b))) => PairContent::Identity { a: a.clone(), b: b.clone() },
        Some((x @ (ExrSamples::Float(_) | ExrSamples::Half(_)), y @ (ExrSamples::Float(_) | ExrSamples::Half(_)))) => {
            let variance = both(&format!("{VARIANCE}{name}")).map(|(a, b)| (a.to_floats(), b.to_floats()));
            PairContent::Number { a: x.to_floats(), b: y.to_floats(), variance }
        }
        _ => {
            return Err(Error::coded(
                ErrorCode::NotComparable,
                path,
                format!("the type of channel {name} differs from that in the other file"),
            ));
        }
    };
    Ok(ChannelPair { name: name.to_owned(), content })
}

fn check_size(path: &Path, a: [usize; 2], b: [usize; 2]) -> Result<(), Error> {
    if a == b {
        return Ok(());
    }
    let what =
        format!("has {} × {} pixels, the other file {} × {}; compare images of the same size", b[0], b[1], a[0], a[1]);
    Err(Error::coded(ErrorCode::NotComparable, path, what))
}

fn compare_images(a: &Path, b: &Path) -> Result<ComparedFiles, Error> {
    let (x, y) = (read_image(a)?, read_image(b)?);
    let (width, height) = (x.width as usize, x.height as usize);
    check_size(b, [width, height], [y.width as usize, y.height as usize])?;
    if kind(&x.pixels) != kind(&y.pixels) {
        let what = format!(
            "contains {}, the other file {}; compare images of the same kind",
            kind(&y.pixels),
            kind(&x.pixels)
        );
        return Err(Error::coded(ErrorCode::NotComparable, b, what));
    }
    let (of_a, of_b) = (channels_of(&x.pixels), channels_of(&y.pixels));
    let names = if of_a.len() == 1 { &["grey"][..] } else { &["R", "G", "B", "A"] };
    let channels = names.iter().zip(of_a).zip(of_b).map(|((name, a), b)| ChannelPair {
        name: (*name).to_owned(),
        content: PairContent::Number { a, b, variance: None },
    });
    Ok(ComparedFiles {
        width,
        height,
        channels: channels.collect(),
        origin: (VarianceOrigin::NONE, VarianceOrigin::NONE),
    })
}

/// Kind of an image's pixels, in words.
fn kind(pixels: &ImagePixels) -> &'static str {
    match pixels {
        ImagePixels::Gray8(_) => "8-bit grey",
        ImagePixels::Gray16(_) => "16-bit grey",
        ImagePixels::Rgb8(_) => "R, G, B of 8 bits",
        ImagePixels::Rgba8(_) => "R, G, B, A of 8 bits",
        ImagePixels::Rgb32F(_) => "R, G, B as numbers",
        ImagePixels::Rgba32F(_) => "R, G, B, A as numbers",
    }
}

/// Channels in the units of the file; 16-bit colours as fractions of 65 535.
fn channels_of(pixels: &ImagePixels) -> Vec<Vec<f32>> {
    let bytes = |sample_bytes: &dyn Fn(usize) -> Vec<f32>, n: usize| (0..n).map(sample_bytes).collect();
    match pixels {
        ImagePixels::Gray8(p) => vec![p.iter().map(|v| f32::from(*v)).collect()],
        ImagePixels::Gray16(p) => vec![p.iter().map(|v| f32::from(*v)).collect()],
        ImagePixels::Rgb8(p) => bytes(&|c| p.iter().map(|v| f32::from(v[c])).collect(), 3),
        ImagePixels::Rgba8(p) => bytes(&|c| p.iter().map(|v| f32::from(v[c])).collect(), 4),
        ImagePixels::Rgb32F(p) => bytes(&|c| p.iter().map(|v| v[c]).collect(), 3),
        ImagePixels::Rgba32F(p) => bytes(&|c| p.iter().map(|v| v[c]).collect(), 4),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::exr::ExrChannel;

    fn exr(quantity: Option<&str>, channels: &[&str]) -> ExrFile {
        let channel = |name: &&str| ExrChannel { name: (*name).to_owned(), samples: ExrSamples::Float(vec![1.0]) };
        let stated = quantity.map(|text| ("etendue:quantity".to_owned(), text.to_owned()));
        ExrFile {
            to_rec_709: None,
            width: 1,
            height: 1,
            channels: channels.iter().map(channel).collect(),
            attributes: BTreeMap::from_iter(stated),
            compression: String::new(),
        }
    }

    fn error_text(a: &ExrFile, b: &ExrFile) -> String {
        compare_exr(Path::new("b.exr"), a, b).err().map_or(String::new(), |e| e.to_string())
    }

    #[test]
    fn results_of_other_kinds_are_refused_in_a_sentence() {
        let electrons = exr(Some("electrons"), &["n"]);
        assert_eq!(error_text(&electrons, &electrons), "");
        assert_eq!(error_text(&electrons, &exr(None, &["n"])), "", "a file of another program states nothing");
        assert_eq!(
            error_text(&electrons, &exr(Some("depth"), &["n"])),
            "b.exr: the quantity is \"depth\", that of the other file \"electrons\"; compare files of the same kind"
        );
        assert_eq!(
            error_text(&exr(None, &["a", "b", "c", "d", "e", "f", "x"]), &exr(None, &["x", "y"])),
            "b.exr: has the channels y instead of a, b, c, d and 2 more; compare files of the same kind"
        );
        assert_eq!(
            error_text(&exr(None, &["n", "variance.n"]), &electrons),
            "b.exr: has no variances, but the other file has; render both with output.variance, or both without"
        );
    }

    #[test]
    fn raw_frames_are_compared_in_digital_numbers() {
        let folder = tempfile::tempdir().expect("temporary folder");
        let written = |name: &str, picture: &image::DynamicImage| {
            let path = folder.path().join(name);
            picture.save(&path).expect("writable");
            path
        };
        let grey = |v: u16| image::DynamicImage::ImageLuma16(image::ImageBuffer::from_pixel(1, 1, image::Luma([v])));
        let (a, b) = (written("a.png", &grey(100)), written("b.png", &grey(40_000)));
        let channels = read_pair(&a, &b).expect("comparable").channels;
        let content = PairContent::Number { a: vec![100.0], b: vec![40_000.0], variance: None };
        assert_eq!(channels, [ChannelPair { name: "grey".to_owned(), content }]);
        let byte = image::DynamicImage::ImageLuma8(image::ImageBuffer::from_pixel(1, 1, image::Luma([7])));
        let message = read_pair(&a, &written("c.png", &byte)).expect_err("another kind").to_string();
        assert!(
            message
                .ends_with("c.png: contains 8-bit grey, the other file 16-bit grey; compare images of the same kind"),
            "{message}"
        );
    }
}
