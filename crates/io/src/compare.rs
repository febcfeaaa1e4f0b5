//! Two results of the same kind, channel beside channel.

use std::path::Path;

use crate::Error;
use crate::exr::{ExrFile, Samples, read_exr};
use crate::picture::read_picture;
use etendue_scene::asset::ImagePixels;

/// The channels of two files of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct Pair {
    /// Pixels a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Channels by name. Previews (R, G, B beside spectral bands) and variances are no channels of their own.
    pub channels: Vec<Channel>,
    /// Replicates behind the variances of the first and the second file, as their headers state; 1 where they do not.
    pub replicates: (u32, u32),
}

/// A channel that both files have.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// Its samples.
    pub content: Content,
}

/// The samples of a channel in the first and in the second file.
#[derive(Clone, Debug, PartialEq)]
pub enum Content {
    /// Numbers, and their variances where both files have them.
    Number {
        /// Of the first file.
        a: Vec<f32>,
        /// Of the second.
        b: Vec<f32>,
        /// Variances of the means.
        variance: Option<(Vec<f32>, Vec<f32>)>,
    },
    /// Identities.
    Identity {
        /// Of the first file.
        a: Vec<u32>,
        /// Of the second.
        b: Vec<u32>,
    },
}

impl Channel {
    /// Whether both files state a variance.
    #[must_use]
    pub fn has_variance(&self) -> bool {
        matches!(self.content, Content::Number { variance: Some(_), .. })
    }
}

/// Reads two files for comparison: EXR with EXR, picture with picture.
pub fn read_pair(a: &Path, b: &Path) -> Result<Pair, Error> {
    let is_exr = |path: &Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("exr"));
    match (is_exr(a), is_exr(b)) {
        (true, true) => of_exr(b, &read_exr(a)?, &read_exr(b)?),
        (false, false) => of_pictures(a, b),
        _ => Err(Error::new(b, format!("cannot be compared with {}: give two EXR files or two pictures", a.display()))),
    }
}

fn of_exr(path: &Path, a: &ExrFile, b: &ExrFile) -> Result<Pair, Error> {
    check_size(path, (a.width, a.height), (b.width, b.height))?;
    let (of_a, of_b) = (names(a), names(b));
    if of_a != of_b {
        let only = |x: &[&str], y: &[&str]| x.iter().filter(|n| !y.contains(n)).copied().collect::<Vec<_>>().join(", ");
        let lacking = only(&of_a, &of_b);
        let surplus = only(&of_b, &of_a);
        let what =
            format!("has other channels: it lacks [{lacking}] and has [{surplus}] more; compare results of one kind");
        return Err(Error::new(path, what));
    }
    let channels = of_a.iter().filter(|name| !name.starts_with(VARIANCE) && !is_preview(a, name));
    let channels = channels.map(|name| channel(path, a, b, name)).collect::<Result<_, _>>()?;
    Ok(Pair { width: a.width, height: a.height, channels, replicates: (replicates(a), replicates(b)) })
}

const VARIANCE: &str = "variance.";

fn names(file: &ExrFile) -> Vec<&str> {
    file.channels.iter().map(|c| c.name.as_str()).collect()
}

/// R, G and B beside spectral bands follow from them.
fn is_preview(file: &ExrFile, name: &str) -> bool {
    ["R", "G", "B"].contains(&name) && file.channels.iter().any(|c| c.name.starts_with("S0."))
}

fn replicates(file: &ExrFile) -> u32 {
    file.attributes.get("etendue:replicates").and_then(|text| text.parse().ok()).unwrap_or(1)
}

fn channel(path: &Path, a: &ExrFile, b: &ExrFile, name: &str) -> Result<Channel, Error> {
    let both = |name: &str| Some((a.channel(name)?, b.channel(name)?));
    let content = match both(name) {
        Some((Samples::Uint(a), Samples::Uint(b))) => Content::Identity { a: a.clone(), b: b.clone() },
        Some((x @ (Samples::Float(_) | Samples::Half(_)), y @ (Samples::Float(_) | Samples::Half(_)))) => {
            let variance = both(&format!("{VARIANCE}{name}")).map(|(a, b)| (a.to_floats(), b.to_floats()));
            Content::Number { a: x.to_floats(), b: y.to_floats(), variance }
        }
        _ => return Err(Error::new(path, format!("channel {name} is of another type than in the other file"))),
    };
    Ok(Channel { name: name.to_owned(), content })
}

fn check_size(path: &Path, a: (usize, usize), b: (usize, usize)) -> Result<(), Error> {
    if a == b {
        return Ok(());
    }
    let what = format!("is {} × {} pixels, the other {} × {}; compare pictures of one size", b.0, b.1, a.0, a.1);
    Err(Error::new(path, what))
}

fn of_pictures(a: &Path, b: &Path) -> Result<Pair, Error> {
    let (x, y) = (read_picture(a)?, read_picture(b)?);
    let (width, height) = (x.width as usize, x.height as usize);
    check_size(b, (width, height), (y.width as usize, y.height as usize))?;
    let (of_a, of_b) = (channels_of(&x.pixels), channels_of(&y.pixels));
    if of_a.len() != of_b.len() {
        let what = format!("has {} channels, the other {}; compare pictures of one kind", of_b.len(), of_a.len());
        return Err(Error::new(b, what));
    }
    let names = if of_a.len() == 1 { &["grey"][..] } else { &["R", "G", "B", "A"] };
    let channels = names
        .iter()
        .zip(of_a)
        .zip(of_b)
        .map(|((name, a), b)| Channel { name: (*name).to_owned(), content: Content::Number { a, b, variance: None } });
    Ok(Pair { width, height, channels: channels.collect(), replicates: (1, 1) })
}

fn channels_of(pixels: &ImagePixels) -> Vec<Vec<f32>> {
    let bytes = |of: &dyn Fn(usize) -> Vec<f32>, n: usize| (0..n).map(of).collect();
    match pixels {
        ImagePixels::Gray8(p) => vec![p.iter().map(|v| f32::from(*v)).collect()],
        ImagePixels::Rgb8(p) => bytes(&|c| p.iter().map(|v| f32::from(v[c])).collect(), 3),
        ImagePixels::Rgba8(p) => bytes(&|c| p.iter().map(|v| f32::from(v[c])).collect(), 4),
        ImagePixels::Rgb32F(p) => bytes(&|c| p.iter().map(|v| v[c]).collect(), 3),
    }
}
