//! Shards on disk: a manifest beside one film a camera.
//!
//! A film's planes hold the shard's tiles; the other pixels are zero. `merge` makes the plan again from the manifest
//! and refuses shards of another plan.

use crate::failure::Failure;
use crate::job::JobRequest;
use etendue_core::Plane;
use etendue_core::quantity::Quantity;
use etendue_io::exr::{ExrFile, Layer, Samples, encode_layers, read_exr_within};
use etendue_io::{OutputFolder, Provenance, sidecar};
use etendue_pipeline::Plan;
use etendue_pipeline::film::Film;
use etendue_pipeline::plan::CameraPlan;
use etendue_pipeline::render::layout;
use std::path::Path;

/// The name of a shard's manifest in its folder.
pub const MANIFEST: &str = "shard.json";

/// What a shard is part of.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The job, so that the plan can be made again.
    pub request: JobRequest,
    /// Frames to take of the whole.
    pub frames: std::ops::Range<u32>,
    /// Which shard.
    pub index: u32,
    /// Of how many.
    pub count: u32,
    /// The plan's hash.
    pub plan_hash: String,
    /// Side of each camera's tiles, px: the plan's hash leaves it out, but it says which pixels are whose.
    pub tile_px: Vec<u32>,
}

/// The sides of the tiles of a plan's cameras.
pub fn tile_sides(plan: &Plan) -> Vec<u32> {
    plan.cameras.iter().map(|camera| camera.settings.tile_px).collect()
}

impl Manifest {
    /// Reads the manifest of a shard's folder.
    pub fn read(folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(MANIFEST);
        let explain =
            |why: String| Failure::input(format!("{}: {why}; give folders made by render --shard", path.display()));
        let text = crate::job::read_text(&path).map_err(explain)?;
        serde_json::from_str(&text)
            .map_err(|error| explain(format!("this is no shard manifest of this version ({error})")))
    }

    /// Writes the manifest.
    pub fn write(&self, folder: &mut OutputFolder) -> Result<(), Failure> {
        let bytes = sidecar::encode(self).map_err(|error| Failure::Run(error.to_string()))?;
        folder.write(MANIFEST, &bytes).map_err(Failure::run)
    }
}

/// The name of a camera's film in a shard's folder.
pub fn film_name(camera: &CameraPlan) -> String {
    format!("{}.film.exr", camera.name)
}

/// The bytes of a film.
pub fn encode(film: &Film, facts: &Provenance) -> Result<Vec<u8>, Failure> {
    let mut layers = vec![
        ("weight".to_owned(), Layer::Float(film.weight.samples())),
        ("not_finite".to_owned(), Layer::Uint(film.not_finite.samples())),
    ];
    if let Some(cube) = &film.cube {
        for (i, (mean, variance)) in cube.mean.planes().iter().zip(cube.variance.planes()).enumerate() {
            layers.push((format!("band.{i:04}.mean"), Layer::Float(mean.samples())));
            layers.push((format!("band.{i:04}.variance"), Layer::Float(variance.samples())));
        }
    }
    if let Some(electrons) = &film.electrons {
        layers.push(("electrons.mean".to_owned(), Layer::Float(electrons.mean.samples())));
        layers.push(("electrons.variance".to_owned(), Layer::Float(electrons.variance.samples())));
    }
    encode_layers(film.weight.width(), film.weight.height(), &layers, facts)
        .map_err(|error| Failure::Run(format!("the film cannot be encoded: {error}")))
}

/// The film of a camera of the plan, from a shard's folder.
pub fn read(folder: &Path, camera: &CameraPlan) -> Result<Film, Failure> {
    let path = folder.join(film_name(camera));
    let (width, height) = camera.film_size();
    // Most of a shard's film is black, and packs well.
    let most_bytes = Film::bytes(width as usize, height as usize, &layout(camera)) as u64;
    let file = read_exr_within(&path, most_bytes).map_err(Failure::input)?;
    decode(&file, camera).ok_or_else(|| {
        Failure::input(format!(
            "{}: this is not the film of camera {}; render the shard again",
            path.display(),
            camera.name
        ))
    })
}

fn decode(file: &ExrFile, camera: &CameraPlan) -> Option<Film> {
    let (width, height) = camera.film_size();
    let (settings, (width, height)) = (&camera.settings, (width as usize, height as usize));
    let mut film = Film::new(width, height, &layout(camera), settings.spp, settings.replicates);
    fill(&mut film.weight, file, "weight")?;
    match file.channel("not_finite")? {
        Samples::Uint(values) if values.len() == width * height => {
            film.not_finite.samples_mut().copy_from_slice(values);
        }
        _ => return None,
    }
    if let Some(cube) = &mut film.cube {
        for (i, plane) in cube.mean.planes_mut().iter_mut().enumerate() {
            fill(plane, file, &format!("band.{i:04}.mean"))?;
        }
        for (i, plane) in cube.variance.planes_mut().iter_mut().enumerate() {
            fill(plane, file, &format!("band.{i:04}.variance"))?;
        }
    }
    if let Some(electrons) = &mut film.electrons {
        fill(&mut electrons.mean, file, "electrons.mean")?;
        fill(&mut electrons.variance, file, "electrons.variance")?;
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
