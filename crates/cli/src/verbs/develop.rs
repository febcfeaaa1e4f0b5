//! `etendue develop`: pictures of raws that were taken before, by a camera file's processing.

use super::render::{claim, commit, open};
use crate::args;
use crate::camera_file;
use crate::facts;
use crate::failure::Failure;
use crate::files::Files;
use crate::machine;
use crate::photographs::encoded;
use crate::raw_file::{Taken, taken};
use crate::results::Results;
use etendue_pipeline::photograph::{Developed, developed};
use etendue_pipeline::plan::{CameraBody, Development};
use etendue_sensor::Sensor;
use serde_json::{Map, Value, json};
use std::path::Path;

pub fn run(arguments: &args::Develop) -> Result<(), Failure> {
    let body = camera_file::load(&arguments.camera, &arguments.set)?;
    let camera = Camera::of(&body).ok_or_else(|| {
        let file = arguments.camera.display();
        Failure::input(format!("{file}: the camera has no [processing], so nothing says how a picture is made: add it"))
    })?;
    let mut folder = open(&arguments.output)?;
    let mut results = Results { prefix: camera_file::name(&arguments.camera), folder: &mut folder };
    claim(results.folder, [format!("{}/{}", results.prefix, Files::DEVELOPMENT)])?;
    let pool = machine::pool(None)?;
    pool.install(|| all(&camera, arguments, &mut results))?;
    commit(folder)
}

/// A camera that makes pictures.
struct Camera<'a> {
    body: &'a CameraBody,
    sensor: &'a Sensor,
    development: &'a Development,
}

impl<'a> Camera<'a> {
    fn of(body: &'a CameraBody) -> Option<Self> {
        Some(Self { body, sensor: body.sensor.as_ref()?, development: body.development.as_ref()? })
    }
}

fn all(camera: &Camera<'_>, arguments: &args::Develop, results: &mut Results<'_>) -> Result<(), Failure> {
    let (mut frames, mut files, mut alike_px) = (Vec::new(), Map::new(), 1);
    for (number, file) in arguments.raws.iter().enumerate() {
        let mut taken =
            taken(file, arguments.levels, number as u32, camera.body, camera.sensor).map_err(Failure::input)?;
        alike_px = alike_px.max(taken.alike_px);
        taken.address.seed = arguments.seed.unwrap_or(taken.address.seed);
        let name = Files::picture(taken.address.frame, camera.development.format);
        if files.contains_key(&name) {
            let told =
                format!("{}: another raw is frame {}, too: develop them apart", file.display(), taken.address.frame);
            return Err(Failure::input(told));
        }
        claim(results.folder, [format!("{}/{name}", results.prefix)])?;
        let picture = developed(camera.development, &taken.raw, taken.address)
            .map_err(|error| Failure::input(format!("{}: {error}", file.display())))?;
        results.write(&name, encoded(&picture.display, camera.development))?;
        frames.push(frame(file, &taken, &picture));
        files.insert(name, Files::picture_entry(camera.development));
    }
    let facts = json!({
        "program": "etendue",
        "version": facts::VERSION,
        "sensor": facts::sensor(camera.body),
        "processing": camera.development.to_string(),
        "frames": frames,
        "sampling": { "alike_px": alike_px },
        "files": files,
    });
    results.json(Files::DEVELOPMENT, &facts)
}

/// What became of a raw.
fn frame(file: &Path, taken: &Taken, picture: &Developed) -> Value {
    json!({
        "frame": taken.address.frame,
        "raw": file.file_name().map(|name| name.to_string_lossy()),
        "seed": taken.address.seed,
        "black_level_dn": picture.facts.black_level_dn,
        "white_level_dn": taken.raw.linear().white_level_dn,
        "white_balance": picture.facts.white_balance,
        "corrected_pixels": picture.facts.corrected_pixels,
    })
}
