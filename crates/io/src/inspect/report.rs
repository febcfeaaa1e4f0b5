//! Report on one file: lines of text, statistics of its channels, and a preview image.
//!
//! Preview images have 8 bits and are sRGB-encoded.
//!
//! Linear values are divided by their 99th percentile of luminance, so that one bright light does not make everything black, and then encoded. NaN becomes
//! magenta; +∞ becomes white.

use std::fmt;
use std::path::{Path, PathBuf};

use etendue_spectra::colour::{encode, luma};
use serde::Serialize;

use crate::{exr::EncodeError, png::encode_rgb8};

/// Content of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FileReport {
    pub file: PathBuf,
    /// Kind, in words.
    pub kind: String,
    /// Facts in reading order: name and value with its unit.
    pub facts: Vec<(String, String)>,
    /// Channels with their statistics.
    pub channels: Vec<ChannelReport>,
    /// Anomalies, assumptions and unused content, in sentences.
    pub notes: Vec<String>,
    /// Image of the content, if possible.
    #[serde(skip)]
    pub preview: Option<Preview>,
}

impl FileReport {
    pub(super) fn new(file: &Path, kind: impl Into<String>) -> Self {
        let (facts, channels, notes) = (Vec::new(), Vec::new(), Vec::new());
        Self { file: file.to_path_buf(), kind: kind.into(), facts, channels, notes, preview: None }
    }

    pub(super) fn state(&mut self, name: &str, value: impl fmt::Display) {
        self.facts.push((name.to_owned(), value.to_string()));
    }
}

impl fmt::Display for FileReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}: {}", self.file.display(), self.kind)?;
        let widest = self.facts.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
        for (name, value) in &self.facts {
            writeln!(f, "  {name:widest$}  {value}")?;
        }
        if !self.channels.is_empty() {
            writeln!(f, "{}", heading(&self.channels))?;
        }
        for channel in &self.channels {
            writeln!(f, "{}", channel.line(widest_name(&self.channels)))?;
        }
        self.notes.iter().try_for_each(|note| writeln!(f, "  note: {note}"))
    }
}

/// Channel with its statistics over finite values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ChannelReport {
    pub name: String,
    /// Storage format of samples.
    pub stored_as: String,
    /// Minimum; `None` without any finite value, as for the next two.
    pub min: Option<f64>,
    pub mean: Option<f64>,
    /// Maximum.
    pub max: Option<f64>,
    /// Number of NaN samples.
    pub nan_count: usize,
    /// Number of infinite samples.
    pub infinite_count: usize,
}

impl ChannelReport {
    /// Returns the statistics of `samples`, summed in order.
    pub fn new(name: &str, stored_as: &str, samples: impl IntoIterator<Item = f64>) -> Self {
        let (mut min, mut max, mut sum, mut count) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0_usize);
        let (mut nan_count, mut infinite_count) = (0, 0);
        for v in samples {
            if v.is_finite() {
                (min, max, sum, count) = (min.min(v), max.max(v), sum + v, count + 1);
            } else if v.is_nan() {
                nan_count += 1;
            } else {
                infinite_count += 1;
            }
        }
        let some = |v: f64| (count > 0).then_some(v);
        Self {
            name: name.to_owned(),
            stored_as: stored_as.to_owned(),
            min: some(min),
            mean: some(sum / count as f64),
            max: some(max),
            nan_count,
            infinite_count,
        }
    }

    /// One line of the table.
    pub(super) fn line(&self, name_width: usize) -> String {
        let cell = |v: Option<f64>| v.map_or_else(|| "-".to_owned(), |v| format!("{v:.6e}"));
        let (min, mean, max) = (cell(self.min), cell(self.mean), cell(self.max));
        let (name, stored, nan, infinite) = (&self.name, &self.stored_as, self.nan_count, self.infinite_count);
        format!("  {name:name_width$}  {stored:6}  {min:>14}  {mean:>14}  {max:>14}  {nan:>7}  {infinite:>8}")
    }
}

/// Header of the table.
fn heading(channels: &[ChannelReport]) -> String {
    let width = widest_name(channels);
    format!(
        "  {:width$}  {:6}  {:>14}  {:>14}  {:>14}  {:>7}  {:>8}",
        "channel", "type", "min", "mean", "max", "NaN", "infinite"
    )
}

/// Width of the widest name.
fn widest_name(channels: &[ChannelReport]) -> usize {
    channels.iter().map(|c| c.name.len()).max().unwrap_or(0).max("channel".len())
}

/// Preview image of a file's content.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// Pixels per row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// sRGB bytes, row by row from the top.
    pub rgb: Vec<[u8; 3]>,
}

/// The colour of NaN.
const NAN_COLOUR: [u8; 3] = [255, 0, 255];

impl Preview {
    /// The bytes of a PNG.
    pub fn to_png(&self) -> Result<Vec<u8>, EncodeError> {
        encode_rgb8(self.width, self.height, self.rgb.as_flattened())
    }

    /// Exposes a linear sRGB image.
    pub(super) fn from_linear(width: usize, height: usize, pixels: &[[f32; 3]]) -> Self {
        let white = white_level(pixels);
        Self { width, height, rgb: pixels.iter().map(|p| byte_pixel(*p, white)).collect() }
    }

    /// Exposes one linear channel as grey: its 99th percentile is white.
    #[must_use]
    pub fn from_grey(width: usize, height: usize, values: &[f32]) -> Self {
        let pixels: Vec<[f32; 3]> = values.iter().map(|v| [*v; 3]).collect();
        Self::from_linear(width, height, &pixels)
    }
}

/// 99th percentile of the luminances that are finite and above 0; 1 if there are none.
fn white_level(pixels: &[[f32; 3]]) -> f32 {
    let mut lit: Vec<f32> = pixels.iter().map(|p| luma(*p)).filter(|y| y.is_finite() && *y > 0.0).collect();
    if lit.is_empty() {
        return 1.0;
    }
    let rank = (lit.len() - 1) * 99 / 100;
    *lit.select_nth_unstable_by(rank, f32::total_cmp).1
}

fn byte_pixel(pixel: [f32; 3], white: f32) -> [u8; 3] {
    if pixel.iter().any(|v| v.is_nan()) {
        return NAN_COLOUR;
    }
    pixel.map(|v| (encode((v / white).clamp(0.0, 1.0)) * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_that_are_not_finite_are_counted_and_left_out() {
        let report = ChannelReport::new("Z", "float", [1.0, f64::NAN, 3.0, f64::INFINITY, f64::NEG_INFINITY]);
        assert_eq!((report.min, report.mean, report.max), (Some(1.0), Some(2.0), Some(3.0)));
        assert_eq!((report.nan_count, report.infinite_count), (1, 2));
        assert_eq!(ChannelReport::new("Z", "float", [f64::INFINITY]).mean, None);
    }

    #[test]
    fn the_99th_percentile_is_white_whatever_the_scale() {
        for scale in [1e-9_f32, 1.0, 1e12] {
            let mut values: Vec<f32> = (1..=100).map(|i| i as f32 * scale).collect();
            values[99] = 1e6 * scale;
            let preview = Preview::from_grey(100, 1, &values);
            assert_eq!(preview.rgb[98], [255; 3], "rank 98 of 0 to 99 is the 99th percentile");
            assert!(preview.rgb[97][0] < 255 && preview.rgb[49][0] > 180);
        }
    }

    #[test]
    fn darkness_and_what_is_not_finite_have_their_colours() {
        assert_eq!(Preview::from_grey(1, 1, &[0.0]).rgb, [[0; 3]]);
        assert_eq!(Preview::from_grey(3, 1, &[f32::NAN, f32::INFINITY, 2.0]).rgb, [NAN_COLOUR, [255; 3], [255; 3]]);
        assert_eq!(Preview::from_grey(2, 1, &[-5.0, 1.0]).rgb, [[0; 3], [255; 3]]);
    }
}
