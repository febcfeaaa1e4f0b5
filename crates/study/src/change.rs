//! Effect of a change on its frame: time, light, digital numbers, image and geometry.

use crate::edge::{EdgeChart, Mtf50};
use crate::error::Estimate;
use crate::frame_render::RenderPair;
use crate::light_distribution::{change_of_contrast, change_of_corners};
use crate::pictures::{QUALITY, side_by_side};
use etendue::{Error, GroundTruth, display_jpeg};
use etendue_core::Plane;
use etendue_core::maths::f64::acos;
use etendue_core::quantity::Quantity;
use glam::DVec3;
use serde::Serialize;

/// Side of the tiles with correlated errors, px, and of the cells whose light normalises errors.
const TILE_PX: usize = 16;

/// Difference between the frame with a change and the frame of the unchanged job.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FrameChange {
    /// CPU time of all threads (wall-clock time on machines that do not report it) saved in loading the job and rendering one frame with its samples, s;
    /// below 0 if the change takes longer.
    pub cpu_saved_s: f64,
    /// Root mean square change of a pixel's mean light, over the mean light of the surrounding 16 × 16 px: of electrons if there are any, otherwise of
    /// irradiance over all wavelengths, at the pupil of radiance. `None` if the light has another size or is another quantity.
    pub light: Option<Estimate>,
    /// Root mean square change of the digital numbers of one frame, DN, with equal random numbers; `None` if there are none, or of another size.
    pub raw_dn: Option<f64>,
    /// Root mean square change of the encoded image, 0 to 1; `None` if there is none, or of another size.
    pub picture: Option<f64>,
    /// Fraction of the pixels that see another instance.
    pub instances: Option<f64>,
    /// Root mean square relative change of the distance seen by a pixel, over pixels that see the same instance.
    pub distance: Option<f64>,
    /// Root mean square change of the direction of a pixel's ray, in pixels at the centre of the image.
    pub direction_px: Option<f64>,
    /// Factor by which the ratio of the light of the corners (an eighth of width and height each) to that of the centre (a quarter of both) changes, in the
    /// quantity of `light`: 1 if vignetting is unchanged. `None` if it is dark, or the light has another size or is another quantity.
    pub corners: Option<Estimate>,
    /// Change of (bright − dark)/(bright + dark), where dark and bright are the 5 % and 95 % percentiles of the means of 16 × 16 px. `None` in the same
    /// cases.
    pub contrast: Option<Estimate>,
    /// Contrast transfer without and with the change, of a chart of edges before this camera; `None` if not requested, or if the camera with the change makes
    /// no image of a chart.
    pub mtf50: Option<[Mtf50; 2]>,
    /// The unchanged frame, the frame with the change, and four times their difference on grey, side by side, JPEG; `None` if there is no image of the same
    /// size.
    #[serde(skip)]
    pub jpeg: Option<Vec<u8>>,
}

impl FrameChange {
    /// Compares the frames of both jobs, with `spp` samples per pixel.
    pub(crate) fn new(own: &RenderPair, changed: &RenderPair, spp: f64) -> Result<Self, Error> {
        let truths = [own, changed].map(|pair| pair.many.results.ground_truth());
        let same =
            |a: &RenderPair, b: &RenderPair| a.many.results.camera().body.raster == b.many.results.camera().body.raster;
        let is_same = same(own, changed);
        let numbers = own.many.raw.as_ref().zip(changed.many.raw.as_ref()).filter(|(a, b)| a.len() == b.len());
        let images = own.many.picture.as_ref().zip(changed.many.picture.as_ref());
        let images = images.filter(|(a, b)| (a.width(), a.height()) == (b.width(), b.height()));
        Ok(Self {
            cpu_saved_s: own.seconds(spp) - changed.seconds(spp),
            light: change_of_light(own, changed),
            raw_dn: numbers.map(|(a, b)| root_mean_square(a.iter().zip(b).map(|(a, b)| f64::from(*a) - f64::from(*b)))),
            picture: images.map(|(a, b)| {
                let channels = a.samples().iter().flatten().zip(b.samples().iter().flatten());
                root_mean_square(channels.map(|(a, b)| f64::from(*a) - f64::from(*b)))
            }),
            instances: is_same.then(|| differing_fraction(&truths[0].instance, &truths[1].instance)),
            distance: is_same.then(|| change_of_distance(&truths)),
            direction_px: is_same.then(|| change_of_direction(own, changed)),
            corners: change_of_corners(own, changed),
            contrast: change_of_contrast(own, changed),
            mtf50: None,
            jpeg: images.map(|(a, b)| display_jpeg(&side_by_side(a, b), QUALITY)).transpose()?,
        })
    }

    /// Adds the change of contrast transfer at edges.
    pub(crate) fn with_edges(self, edges: Option<&EdgeChart<'_>>, set: &[String]) -> Result<Self, Error> {
        let mtf50 = edges.map(|edges| edges.change(set)).transpose()?.flatten();
        Ok(Self { mtf50, ..self })
    }

    /// The figures as a row under [`header`].
    pub(crate) fn row(&self) -> String {
        let percent = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{:.2} %", 100.0 * v));
        let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |v| format!("{v:.2}"));
        let factor = self.corners.map_or_else(none, crate::report::figure);
        let points = self.contrast.map_or_else(none, crate::report::percent);
        let middle = self.mtf50.map_or_else(none, |pair| transfer(pair.map(|mtf50| mtf50.middle)));
        let far_field = self.mtf50.map_or_else(none, |pair| transfer(pair.map(|mtf50| mtf50.far)));
        let light = self.light.map_or_else(|| "–".to_owned(), crate::report::percent);
        format!(
            "{:>8.1} s {light:>14} {:>9} {:>9} {:>9} {:>9} {:>9} {factor:>15} {points:>15} {middle:>13} {far_field:>13}",
            self.cpu_saved_s,
            number(self.raw_dn),
            percent(self.picture),
            percent(self.instances),
            percent(self.distance),
            number(self.direction_px)
        )
    }
}

/// Header of the rows.
pub(crate) fn header() -> String {
    format!(
        "{:>10} {:>14} {:>9} {:>9} {:>9} {:>9} {:>9} {:>15} {:>15} {:>13} {:>13}",
        "saved",
        "light (rms)",
        "raw, DN",
        "image",
        "other ids",
        "distance",
        "rays, px",
        "corners, times",
        "contrast, by",
        "MTF50 middle",
        "MTF50 far"
    )
}

fn none() -> String {
    "–".to_owned()
}

/// Frequencies without and with a change, cycles per pixel.
fn transfer(pair: [Option<Estimate>; 2]) -> String {
    let word = |e: Option<Estimate>| e.map_or_else(none, |e| format!("{:.3}", e.value));
    let [without, with] = pair.map(word);
    format!("{without} → {with}")
}

fn root_mean_square(values: impl Iterator<Item = f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        (sum, count) = (sum + value * value, count + 1.0);
    }
    if count > 0.0 { (sum / count).sqrt() } else { 0.0 }
}

/// Root of the mean product of two independent differences, each normalised by the surrounding light: free of the noise of either.
fn change_of_light(own: &RenderPair, changed: &RenderPair) -> Option<Estimate> {
    let planes = [&own.few_samples, &changed.few_samples, &own.many, &changed.many].map(|render| render.light.as_ref());
    let [Some((kind, a)), Some((other, b)), Some((_, c)), Some((_, d))] = planes else { return None };
    let (width, height) = (a.width(), a.height());
    if kind != other || [b, c, d].iter().any(|plane| (plane.width(), plane.height()) != (width, height)) {
        return None;
    }
    let mean_of = |plane: &Plane<_>, x0: usize, y0: usize| {
        let cell = (y0..(y0 + TILE_PX).min(height)).flat_map(|y| (x0..(x0 + TILE_PX).min(width)).map(move |x| (x, y)));
        let (sum, count) = cell.fold((0.0, 0.0), |(sum, n), (x, y)| (sum + f64::from(at(plane, x, y)), n + 1.0));
        sum / count
    };
    let total: f64 = c.samples().iter().map(|v| f64::from(*v)).sum::<f64>() / c.samples().len() as f64;
    let mut groups = Vec::new();
    for y0 in (0..height).step_by(TILE_PX) {
        for x0 in (0..width).step_by(TILE_PX) {
            let light = mean_of(c, x0, y0).max(1e-3 * total);
            let (mut sum, mut count) = (0.0, 0);
            for y in y0..(y0 + TILE_PX).min(height) {
                for x in x0..(x0 + TILE_PX).min(width) {
                    let difference = |p, q| f64::from(at(p, x, y)) - f64::from(at(q, x, y));
                    (sum, count) = (sum + difference(a, b) * difference(c, d), count + 1);
                }
            }
            if light > 0.0 {
                groups.push((sum / (light * light), count));
            }
        }
    }
    Some(Estimate::from_groups(&groups).root())
}

fn at<Q: Quantity>(plane: &Plane<Q>, x: usize, y: usize) -> Q::Sample {
    plane.at(x, y)
}

/// Fraction of differing values.
fn differing_fraction<Q: Quantity>(a: &Plane<Q>, b: &Plane<Q>) -> f64
where
    Q::Sample: PartialEq,
{
    let count = a.samples().iter().zip(b.samples()).filter(|(a, b)| a != b).count();
    count as f64 / a.samples().len().max(1) as f64
}

fn change_of_distance([a, b]: &[GroundTruth; 2]) -> f64 {
    let pairs = a.distance.samples().iter().zip(b.distance.samples());
    let ids = a.instance.samples().iter().zip(b.instance.samples());
    let same_surface = pairs.zip(ids).filter(|((a, b), (i, j))| a.is_finite() && b.is_finite() && **a > 0.0 && i == j);
    root_mean_square(same_surface.map(|((a, b), _)| f64::from(*b) / f64::from(*a) - 1.0))
}

/// Root mean square angle between the rays of pixel centres, over the angle between neighbours at the centre.
fn change_of_direction(own: &RenderPair, changed: &RenderPair) -> f64 {
    let [a, b] = [own, changed].map(|pair| pair.many.results.rays().direction);
    let vector = |v: [f32; 3]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
    let angle = |a: DVec3, b: DVec3| {
        // For small angles the chord is exact where the cosine loses all digits.
        let chord = (a - b).length();
        if chord < 0.1 { chord } else { acos(a.dot(b).clamp(-1.0, 1.0)) }
    };
    let (x, y) = (a.width() / 2, a.height() / 2);
    let pixel = angle(vector(a.at(x, y)), vector(a.at(x.saturating_sub(1), y)));
    let pairs = a.samples().iter().zip(b.samples()).map(|(a, b)| angle(vector(*a), vector(*b)));
    let known = pairs.filter(|angle| angle.is_finite());
    if pixel > 0.0 { root_mean_square(known) / pixel } else { 0.0 }
}
