//! Films on disk: what a shard hands to `merge`, and the state of a progressive run.
//!
//! Every number of a film is stored as it is in memory (32 bits), so that one that is read back is the same to the bit.

use crate::error::Error;
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Quantity};
use etendue_io::Provenance;
use etendue_io::exr::{ExrFile, ExrImage, Layer, Samples, layers_image, read_exr_within};
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::{CameraPlan, TimeDependence};
use etendue_pipeline::render::{Shot, layout};
use std::path::Path;

/// How the name of a film ends.
pub(crate) const FILM: &str = ".film.exr";

/// The name of a camera's film; with frame and capture where each has its own.
pub(crate) fn film_name(camera: &CameraPlan, shot: Shot) -> String {
    let Shot { frame, capture } = shot;
    match camera.time {
        TimeDependence::None => format!("{}{FILM}", camera.name),
        TimeDependence::Lights | TimeDependence::Motion => format!("{}.{frame:04}.{capture}{FILM}", camera.name),
    }
}

/// A film, to be written.
pub(crate) fn image<'a>(film: &'a Film, facts: &Provenance) -> ExrImage<'a> {
    let mut layers = vec![
        ("weight".to_owned(), Layer::Float(film.weight.samples())),
        ("samples".to_owned(), Layer::Uint(film.samples.samples())),
        ("not_finite".to_owned(), Layer::Uint(film.not_finite.samples())),
    ];
    if let Some((bands, [mean, variance])) = film.bands() {
        for i in 0..bands.count() {
            layers.push((format!("band.{i:04}.mean"), Layer::Band(mean, i)));
            layers.push((format!("band.{i:04}.variance"), Layer::Band(variance, i)));
        }
    }
    if let Some(rate) = &film.electron_rate {
        layers.push(("electron_rate.mean".to_owned(), Layer::Float(rate.mean.samples())));
        layers.push(("electron_rate.variance".to_owned(), Layer::Float(rate.variance.samples())));
    }
    if let Some(watched) = &film.watched {
        layers.push(("watched.mean".to_owned(), Layer::Float(watched.mean.samples())));
        layers.push(("watched.variance".to_owned(), Layer::Float(watched.variance.samples())));
    }
    layers_image(film.weight.width(), film.weight.height(), &layers, facts)
}

/// A film of a camera of the plan, and its facts; `None` where the file holds another film.
pub(crate) fn read(path: &Path, camera: &CameraPlan) -> Result<Option<(Film, Provenance)>, Error> {
    let (width, height) = camera.film_size();
    // Most of a shard's film is black, and packs well.
    let most_bytes = Film::bytes(width as usize, height as usize, &layout(camera)) as u64;
    let file = read_exr_within(path, most_bytes).map_err(Error::input)?;
    Ok(decode(&file, camera).map(|film| (film, file.provenance())))
}

fn decode(file: &ExrFile, camera: &CameraPlan) -> Option<Film> {
    let (width, height) = camera.film_size();
    let (settings, (width, height)) = (&camera.settings, (width as usize, height as usize));
    let mut film = Film::new(width, height, &layout(camera), settings.replicates);
    fill(&mut film.weight, file, "weight")?;
    fill_counts(&mut film.samples, file, "samples")?;
    fill_counts(&mut film.not_finite, file, "not_finite")?;
    if let Some(cube) = film.cube_mut() {
        for (i, plane) in cube.mean.planes_mut().iter_mut().enumerate() {
            fill(plane, file, &format!("band.{i:04}.mean"))?;
        }
        for (i, plane) in cube.variance.planes_mut().iter_mut().enumerate() {
            fill(plane, file, &format!("band.{i:04}.variance"))?;
        }
    }
    if let Some(rate) = &mut film.electron_rate {
        fill(&mut rate.mean, file, "electron_rate.mean")?;
        fill(&mut rate.variance, file, "electron_rate.variance")?;
    }
    if let Some(watched) = &mut film.watched {
        fill(&mut watched.mean, file, "watched.mean")?;
        fill(&mut watched.variance, file, "watched.variance")?;
    }
    Some(film)
}

fn fill<Q: Quantity<Sample = f32>>(plane: &mut Plane<Q>, file: &ExrFile, name: &str) -> Option<()> {
    match file.channel(name)? {
        Samples::Float(values) if values.len() == plane.samples().len() => {
            plane.samples_mut().copy_from_slice(values);
            Some(())
        }
        _ => None,
    }
}

fn fill_counts(plane: &mut Plane<Identity>, file: &ExrFile, name: &str) -> Option<()> {
    match file.channel(name)? {
        Samples::Uint(values) if values.len() == plane.samples().len() => {
            plane.samples_mut().copy_from_slice(values);
            Some(())
        }
        _ => None,
    }
}
