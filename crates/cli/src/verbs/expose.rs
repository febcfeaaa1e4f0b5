//! `etendue expose`: another lens and sensor on stored radiance.

use super::render::{claim, commit, open};
use crate::args;
use crate::camera_file;
use crate::facts;
use crate::failure::Failure;
use crate::files::Files;
use crate::machine;
use crate::photographs::{Wanted, photographs};
use crate::results::Results;
use crate::tell;
use etendue_core::quantity::{Length, Radiance};
use etendue_core::{Plane, SpectralCube};
use etendue_io::Provenance;
use etendue_io::exr::{SpectralImage, read_spectral};
use etendue_optics::{DepthOfField, OpticsError, PupilProjection};
use etendue_pipeline::defocus::{held_margin_px, margin_px};
use etendue_pipeline::photograph::{self, Light};
use etendue_pipeline::plan::{CameraBody, Products, RawFormat};
use etendue_sensor::FrameAddress;
use serde_json::json;
use std::path::Path;

/// A stored radiance image that a lens can be put before.
struct Stored {
    radiance: SpectralCube<Radiance>,
    /// Distance of what each pixel sees; `None` in files of former versions.
    distance: Option<Plane<Length>>,
    projection: PupilProjection,
    provenance: Provenance,
}

impl Stored {
    /// The place of the camera that rendered it in its job; 0 in files of former versions.
    fn camera_index(&self) -> u32 {
        self.provenance.further.get("camera_index").and_then(|i| i.parse().ok()).unwrap_or(0)
    }
}

impl Stored {
    /// Pixels whose errors may be equal.
    fn alike_px(&self) -> u32 {
        self.provenance.further.get("alike_px").and_then(|n| n.parse().ok()).unwrap_or(1)
    }
}

pub fn run(arguments: &args::Expose) -> Result<(), Failure> {
    let body = camera_file::load(&arguments.camera, &arguments.set)?;
    let stored = stored(&arguments.radiance)?;
    let mut folder = open(&arguments.output)?;
    let name = camera_file::name(&arguments.camera);
    let files = Files::of(&products(&body), &body, &arguments.frames);
    let claimed = files.keys().map(String::as_str).chain([Files::SIDECAR]);
    claim(&folder, claimed.map(|file| format!("{name}/{file}")))?;
    let mut results = Results { prefix: name, folder: &mut folder };
    let pool = machine::pool(None)?;
    pool.install(|| expose(&body, &stored, arguments, &mut results))?;
    commit(folder)
}

/// Everything that the camera can make of the light.
fn products(body: &CameraBody) -> Products {
    Products {
        radiance: false,
        irradiance: true,
        ghosts: body.effects.ghosts().is_some(),
        variance: false,
        electrons: false,
        raw: body.sensor.is_some(),
        raw_format: RawFormat::usual(body.sensor.as_ref()),
        causes: false,
        picture: body.development.is_some(),
        ground_truth: false,
        camera_space_position: false,
        depth_png_per_m: None,
        rays: false,
        undistorted: None,
    }
}

fn stored(path: &Path) -> Result<Stored, Failure> {
    let refuse = |why: &str| Failure::input(format!("{}: {why}", path.display()));
    let file = read_spectral(path).map_err(Failure::input)?;
    let SpectralImage::Radiance(image) = file.image else {
        return Err(refuse("this is irradiance behind a lens; expected radiance, rendered with route = \"pupil\""));
    };
    let remedy = "its geometry is not stated; expected radiance that etendue rendered with route = \"pupil\"";
    let provenance = file.provenance.ok_or_else(|| refuse(remedy))?;
    let radiance = image.cube;
    let through_lens = "it was rendered through a lens; render it with --set render.route=pupil to expose it";
    let geometry = facts::pupil_geometry(&provenance, radiance.width(), radiance.height());
    let projection = geometry.ok_or_else(|| refuse(through_lens))?.map_err(|why| refuse(&why))?;
    Ok(Stored { radiance, distance: file.distance, projection, provenance })
}

fn expose(
    body: &CameraBody,
    stored: &Stored,
    arguments: &args::Expose,
    results: &mut Results<'_>,
) -> Result<(), Failure> {
    let Stored { radiance, projection, distance, .. } = stored;
    let at_pupil = photograph::Stored { projection, radiance, distance: distance.as_ref() };
    let refuse = |error: OpticsError| {
        let (radiance, camera) = (arguments.radiance.display(), arguments.camera.display());
        Failure::input(format!("{radiance} through {camera}: {error}{}", margin(body)))
    };
    let depth_of_field = depth_of_field(body, stored, arguments)?;
    remark_margin(body, stored, &depth_of_field).map_err(refuse)?;
    let light = Light::at_pupil(body, &at_pupil, &depth_of_field).map_err(refuse)?;
    let seed = arguments.seed.unwrap_or(stored.provenance.seed);
    let facts = facts::exposed_provenance(&stored.provenance, &results.prefix, seed);
    results.irradiance(&light, false, &facts)?;
    results.ghosts(&light, &facts)?;
    let mut points = Vec::new();
    if let Some(electrons) = &light.electrons {
        let address = |frame| FrameAddress { seed, camera: stored.camera_index(), frame, capture: 0 };
        let products = products(body);
        let wanted = Wanted { products: &products, camera: &results.prefix.clone(), facts: &facts, undistorted: None };
        points = photographs(body, electrons, &arguments.frames, address, wanted, results)?;
    }
    let mut facts = sidecar(body, stored, arguments, seed, &depth_of_field);
    facts["frames"] = points.into();
    results.json(Files::SIDECAR, &facts)
}

/// What the camera's effects need beyond its picture, where they need anything.
fn margin(body: &CameraBody) -> String {
    match body.effects.margin_px() {
        [0, 0] => String::new(),
        [x, y] => format!(
            "; the camera's [effects] need {x} columns and {y} rows beyond its picture: give them a smaller \"margin\", or \
             render with more \"overscan\""
        ),
    }
}

/// The depth of field that is asked for; where nothing is said, the physical one as far as lens and image allow.
fn depth_of_field(body: &CameraBody, stored: &Stored, arguments: &args::Expose) -> Result<DepthOfField, Failure> {
    let blurs = body.lens.entrance_pupil_radius_m() > 0.0;
    let file = arguments.radiance.display();
    match arguments.depth_of_field {
        Some(DepthOfField::None) => Ok(DepthOfField::None),
        Some(_) if stored.distance.is_none() => Err(Failure::input(format!(
            "{file}: it has no distances (channel distance.Z), which depth of field needs: render it anew, or give \
             --depth-of-field none"
        ))),
        Some(DepthOfField::Physical) if !blurs => Err(Failure::input(format!(
            "--depth-of-field physical has no effect: to the lens of {} everything is sharp",
            arguments.camera.display()
        ))),
        Some(asked) => Ok(asked),
        None if blurs && stored.distance.is_some() => Ok(DepthOfField::Physical),
        None => {
            if blurs {
                tell(&format!("warning: {file} has no distances (channel distance.Z): defocus is left out\n"));
            }
            Ok(DepthOfField::None)
        }
    }
}

/// Says where blurs from outside of the picture are cut off.
fn remark_margin(body: &CameraBody, stored: &Stored, depth_of_field: &DepthOfField) -> Result<(), OpticsError> {
    let wanted = margin_px(depth_of_field, body);
    let held = held_margin_px(&stored.projection, body, stored.radiance.bands(), depth_of_field)?;
    if held < wanted {
        tell(&format!(
            "warning: depth of field needs {wanted} px around the picture and the image holds {held}: blurs are cut off at \
             its edges; render with more overscan\n"
        ));
    }
    Ok(())
}

fn sidecar(
    body: &CameraBody,
    stored: &Stored,
    arguments: &args::Expose,
    seed: u64,
    depth_of_field: &DepthOfField,
) -> serde_json::Value {
    json!({
        "program": "etendue",
        "version": facts::VERSION,
        "seed": seed,
        "camera_index": stored.camera_index(),
        "radiance": {
            "plan_hash": stored.provenance.plan_hash,
            "version": stored.provenance.version,
            "camera": stored.provenance.camera,
        },
        "pose": { "camera_to_world": stored.provenance.camera_to_world },
        "optics": facts::optics(body),
        "effects": facts::effects(body),
        "sensor": facts::sensor(body),
        "route": "pupil",
        "sampling": { "alike_px": stored.alike_px() },
        "depth_of_field": facts::depth_of_field(depth_of_field),
        "files": Files::of(&products(body), body, &arguments.frames),
        "time_s": stored.provenance.time_s,
    })
}
