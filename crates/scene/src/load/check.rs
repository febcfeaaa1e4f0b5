//! Checks that need more than one record: names that must exist, cameras with their job.

use std::collections::BTreeSet;

use super::{CameraSetup, names};
use crate::document::Node;
use crate::fault::{Faults, Named};
use crate::place::Placed;
use crate::reader::{Rule as _, list, record};
use crate::record::CameraEntry;
use crate::record::render::check_merged;
use crate::suggest::nearest;

/// Every name that was used while reading is defined.
pub(super) fn references(document: &Node, faults: &mut Faults) {
    let uses = faults.take_uses();
    let known = |named| match named {
        Named::Mesh => names::of(document, "meshes"),
        Named::Texture => names::of(document, "textures"),
        Named::Material => names::of(document, "materials"),
        Named::Class => names::of_classes(document),
    };
    for named in [Named::Mesh, Named::Texture, Named::Material, Named::Class] {
        let known = known(named);
        let defined: BTreeSet<_> = known.iter().copied().collect();
        for (_, name) in uses.iter().filter(|(n, name)| *n == named && !defined.contains(name.as_str())) {
            note_unknown(named.word(), name, &known, faults);
        }
    }
}

fn note_unknown(what: &str, name: &Placed<String>, known: &[&str], faults: &mut Faults) {
    let remedy = match (known, nearest(name, known)) {
        ([], _) => format!("define the {what}, the scene has none"),
        (_, Some(near)) => format!("did you mean \"{near}\"? Known: {}", known.join(", ")),
        (_, None) => format!("define the {what}, or use one that is known: {}", known.join(", ")),
    };
    faults.add(&name.place, format!("there is no {what} \"{}\"", name.value), remedy);
}

/// Every camera agrees with what is asked of it. Only those parts are looked at that are right one by one; they are read
/// again from the document, for a fault in the scene must not hide one here.
pub(super) fn cameras(document: &Node, faults: &mut Faults) {
    for setup in setups(document).unwrap_or_default() {
        let setup = &setup;
        check_merged(&setup.render, faults);
        check_output(setup, faults);
    }
}

/// The cameras that are right, if the job's own tables are.
fn setups(document: &Node) -> Option<Vec<CameraSetup>> {
    let job = document.as_table()?;
    let quiet = &mut Faults::none();
    let cameras = list(record::<CameraEntry>(), 0).read(job.get("cameras")?, quiet)?;
    let render = job.get("render").map(|n| record().read(n, quiet));
    let output = job.get("output").map(|n| record().read(n, quiet));
    if render.as_ref().is_some_and(Option::is_none) || output.as_ref().is_some_and(Option::is_none) {
        return None;
    }
    let (render, output) = (render.flatten(), output.flatten());
    Some(cameras.into_iter().map(|c| CameraSetup::new(c, render.as_ref(), output.as_ref())).collect())
}

/// What is to be written can be made, and no key of it is without effect.
fn check_output(setup: &CameraSetup, faults: &mut Faults) {
    check_makers(setup, faults);
    let (output, render) = (&setup.output, &setup.render);
    if let (Some(flag), Some(1)) = (wanted(&output.variance), render.replicates.as_ref().map(|r| r.value)) {
        faults.add(&flag.place, "one replicate tells no variance", "give \"replicates\" = 2 or more");
    }
    if let (Some(scale), None) = (&output.depth_png_scale, wanted(&output.depth_png)) {
        let problem = "\"depth_png_scale\" has no effect without \"depth_png\"";
        faults.add(scale.place(), problem, "add \"depth_png = true\", or remove it");
    }
}

/// The camera has the parts that make what is wanted of it.
fn check_makers(setup: &CameraSetup, faults: &mut Faults) {
    let (output, camera, name) = (&setup.output, &setup.camera, &setup.name.value);
    if camera.sensor.electronics.is_none() {
        for flag in [&output.electrons, &output.raw, &output.picture].into_iter().filter_map(wanted) {
            let problem = format!("the sensor of camera \"{name}\" has no electronics to make it");
            faults.add(
                &flag.place,
                problem,
                "add \"exposure_s\", \"cfa\", … to the sensor, or say false for this camera",
            );
        }
    } else if let (Some(flag), None) = (wanted(&output.picture), &camera.processing) {
        let problem = format!("camera \"{name}\" has no processing to make it");
        faults.add(&flag.place, problem, "add \"processing\" (it may be empty), or say false for this camera");
    }
}

/// The flag, where it says true.
fn wanted(flag: &Option<Placed<bool>>) -> Option<&Placed<bool>> {
    flag.as_ref().filter(|f| f.value)
}
