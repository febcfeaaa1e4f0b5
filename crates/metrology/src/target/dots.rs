//! Dots: grids of discs, dark on bright or bright on dark.
//!
//! Dots are dark regions below a local threshold ([`threshold`]), at least four pixels across, not cut by the border, and with
//! the area of the ellipse of their own second moments (to 4 %, small ones to 12 %; a rectangle has 4.5 % less). They are
//! arranged in rows and columns by position ([`lattice`]). Then each is measured ([`centroid`]), and the common effect of the
//! pixel raster is subtracted.

use glam::{DMat2, DVec2};
use rayon::prelude::*;

use super::centroid::{self, Blob, Centroid, Moments};
use super::lattice::{self, PointMap};
use super::threshold::{self, RowRun, Threshold};
use super::{Grid, MIN_GRID_POINTS};
use crate::Image;

/// The largest grid of dots of an image, of any size, and the number of points of the second largest.
pub(super) fn find(image: &Image) -> (Grid, usize) {
    // Fractions of the image's shorter side: from dots of a few pixels to dots of a tenth of the image.
    const BLOCKS: [usize; 3] = [48, 20, 8];
    let turned = image.map(|v| -v);
    let mut best = ((PointMap::new(), 0), Vec::new(), false);
    for divisor in BLOCKS {
        let block = (image.width().min(image.height()) / divisor).max(8);
        for (image, bright) in [(image, false), (&turned, true)] {
            let blobs = blobs(image, block);
            let places = places(&blobs);
            if places.0.len() > best.0.0.len() {
                best = (places, blobs, bright);
            }
        }
    }
    let ((places, outside), blobs, bright) = best;
    (measure_dots(if bright { &turned } else { image }, &places, &blobs, bright), outside)
}

fn blobs(image: &Image, block: usize) -> Vec<Blob> {
    let regions = threshold::dark(image, &Threshold::from_image(image, block));
    regions.iter().filter_map(|runs| blob(image, runs)).collect()
}

/// A region that is complete, large enough and elliptical.
fn blob(image: &Image, runs: &[RowRun]) -> Option<Blob> {
    const MIN_PX: f64 = 12.0;
    const SMALL_PX: usize = 200;
    let inside = |r: &RowRun| r.row > 0 && r.row + 1 < image.height() && r.from > 0 && r.to < image.width();
    let pixels: usize = runs.iter().map(|r| r.to - r.from).sum();
    if (pixels as f64) < MIN_PX || pixels > image.samples().len() / 10 || !runs.iter().all(inside) {
        return None;
    }
    let mut moments = Moments::default();
    let mut darkest = f32::INFINITY;
    for run in runs {
        for x in run.from..run.to {
            moments.add(DVec2::new(x as f64 + 0.5, run.row as f64 + 0.5), 1.0);
            darkest = darkest.min(image.at(x, run.row));
        }
    }
    let blob = Blob { darkest: f64::from(darkest), ..moments.blob()? };
    let ellipse = 4.0 * std::f64::consts::PI * blob.covariance.determinant().max(0.0).sqrt();
    let tolerance = if pixels < SMALL_PX { 0.12 } else { 0.04 };
    ((blob.area / ellipse - 1.0).abs() < tolerance).then_some(blob)
}

fn places(blobs: &[Blob]) -> (PointMap, usize) {
    let points: Vec<DVec2> = blobs.iter().map(|b| b.at).collect();
    let similar = |a: usize, b: usize| (0.4..2.5).contains(&(blobs[a].area / blobs[b].area));
    let (places, outside) = lattice::largest(&points, MIN_GRID_POINTS, &similar);
    (lattice::straight(places), outside)
}

/// The grid of the dots' centroids; those that cannot be measured are omitted.
fn measure_dots(image: &Image, places: &PointMap, blobs: &[Blob], bright: bool) -> Grid {
    let rough = radius_steps(places, |i| (blobs[i].at, blobs[i].area));
    // An ellipse larger by this factor touches that of the next dot.
    let room = rough.map_or(1.5, |r| 0.5 / r);
    let placed: Vec<usize> = places.values().copied().collect();
    let dots: Vec<Option<Centroid>> =
        placed.par_iter().map(|i| centroid::measure_dot(image, &blobs[*i], room, bright)).collect();
    let blur_px2 = centroid::blur_px2(dots.iter().flatten().map(|c| c.outline));
    let centre = |c: Centroid| Centroid { at: centroid::centre(c.at, &c.outline, blur_px2), ..c };
    let mut centroids = vec![None; blobs.len()];
    placed.iter().zip(dots).for_each(|(i, c)| centroids[*i] = c.map(centre));
    let places: PointMap = places.iter().filter(|(_, i)| centroids[**i].is_some()).map(|(p, i)| (*p, *i)).collect();
    let points: Vec<DVec2> = (0..blobs.len()).map(|i| centroids[i].map_or(blobs[i].at, |c| c.at)).collect();
    let uncertainties: Vec<f64> = centroids.iter().map(|c| c.map_or(f64::INFINITY, |c| c.uncertainty_px)).collect();
    let disc_radius_steps = radius_steps(&places, |i| (points[i], centroids[i].map_or(blobs[i].area, |c| c.area)));
    Grid { disc_radius_steps, ..Grid::from_places(&places, &points, &uncertainties) }
}

/// Radius of the discs in steps, from the areas of dots and of the cells between their neighbours: the mean over all dots.
fn radius_steps(places: &PointMap, dot: impl Fn(usize) -> (DVec2, f64)) -> Option<f64> {
    let radius = |(place, i): (&[i32; 2], &usize)| {
        let step = |axis: usize| {
            let at = |by: i32| {
                let mut other = *place;
                other[axis] += by;
                places.get(&other).map(|i| dot(*i).0)
            };
            Some(0.5 * (at(1)? - at(-1)?))
        };
        let cell = DMat2::from_cols(step(0)?, step(1)?).determinant().abs();
        Some((dot(*i).1 / (std::f64::consts::PI * cell)).sqrt())
    };
    let all: Vec<f64> = places.iter().filter_map(radius).collect();
    (!all.is_empty()).then(|| all.iter().sum::<f64>() / all.len() as f64)
}
