//! Tiles of light as numbers to look at, while it is gathered.
//!
//! Where a spectrum is kept: radiance in linear sRGB, (1, 1, 1) at 1 cd/m², the same numbers as the channels `R`, `G`, `B` of `radiance.exr`. Where pixels
//! make electrons directly: `Y`, the mean electrons of the exposure, each pixel in the colour of its filter.

use etendue_core::observer::{ImageTile, Observer};
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, TimeDependence};
use etendue_pipeline::render::Shot;
use etendue_pipeline::tile::Tile;
use etendue_spectra::colour::linear_srgb_from_xyz;
use etendue_spectra::observer::xyz_weights;

/// Shows a tile of a film to an observer that wants it.
pub(crate) fn show(observer: &dyn Observer, (camera, shot): (&CameraPlan, Shot), tile: Tile, film: &Film) {
    if !observer.wants_tiles() {
        return;
    }
    let (channels, values) = match (&film.cube, &film.electron_rate) {
        (Some(_), _) => match radiance(film, tile) {
            Ok(values) => (&["R", "G", "B"][..], values),
            // The run that cannot read its film tells so itself.
            Err(_) => return,
        },
        (None, Some(_)) => (&["Y"][..], electrons(film, tile, camera.body.exposure.exposure_s)),
        (None, None) => return,
    };
    let size_px = [film.weight.width() as u32, film.weight.height() as u32];
    let image = &name(camera, shot);
    let (first_px, tile_px) = ([tile.x0, tile.y0], [tile.x1 - tile.x0, tile.y1 - tile.y0]);
    observer.tile(&ImageTile { image, size_px, first_px, tile_px, channels, values: &values });
}

/// What a viewer calls a film.
fn name(camera: &CameraPlan, shot: Shot) -> String {
    match (camera.time, shot.capture) {
        (TimeDependence::None, _) => camera.name.clone(),
        (_, 0) => format!("{}, frame {}", camera.name, shot.frame),
        (_, capture) => format!("{}, frame {}, capture {capture}", camera.name, shot.frame),
    }
}

/// Planes of linear sRGB, one after the other.
fn radiance(film: &Film, tile: Tile) -> Result<Vec<f32>, String> {
    let Some(((of, _), bands)) = film.bands().zip(film.tile_bands(tile)?) else { return Ok(Vec::new()) };
    let weights: Vec<[f64; 3]> = xyz_weights(of).into_iter().map(linear_srgb_from_xyz).collect();
    let mut sums = vec![0.0_f64; 3 * tile.len()];
    for (place, pixel) in tile.pixels().enumerate() {
        let pupil_sr = film.weight.at(pixel.x as usize, pixel.y as usize);
        if pupil_sr > 0.0 {
            for (mean, weight) in bands.means(pixel).zip(&weights) {
                let radiance = f64::from(mean / pupil_sr);
                (0..3).for_each(|channel| sums[channel * tile.len() + place] += weight[channel] * radiance);
            }
        }
    }
    Ok(sums.into_iter().map(|sum| sum as f32).collect())
}

/// Mean electrons of an exposure, s.
fn electrons(film: &Film, tile: Tile, exposure_s: f64) -> Vec<f32> {
    let Some(rate) = &film.electron_rate else { return Vec::new() };
    let of = |x: u32, y: u32| (f64::from(rate.mean.at(x as usize, y as usize)) * exposure_s) as f32;
    tile.pixels().map(|pixel| of(pixel.x, pixel.y)).collect()
}
