//! Files that a description names.

use std::collections::BTreeMap;

use super::usage::UnusedNames;
use crate::asset::file_list::{FileList, NamesFiles as _};
use crate::asset::{AssetKind, AssetRequest, LensQuantity, ReplacedMaterials, SpectrumValues};
use crate::place::Placed;
use crate::record::effects::ModulationSource;
use crate::record::front::mirror::{Finish, MirrorShape};
use crate::record::lens::calibrated::{IlluminationSource, PixelDirections};
use crate::record::lens::prescription::{IrCutCurve, SurfaceListSource};
use crate::record::sensor::QuantumEfficiency;
use crate::record::weather::Weather;
use crate::record::{
    Body, Camera, Environment, ExternalOptics, Lens, Light, MotionKeys, Object, Pose, Processing, Scene,
};

/// Returns every named file, each once.
pub(crate) fn requests<'d>(
    scene: &Scene,
    unused: &UnusedNames,
    cameras: impl Iterator<Item = (&'d Camera, &'d Pose)>,
) -> Vec<AssetRequest> {
    let mut files = FileList::default();
    let covered = replaced_materials(scene);
    for mesh in scene.meshes.iter().filter(|m| !unused.meshes.contains(&m.name.value)) {
        let covered = covered.get(mesh.name.as_str()).cloned().unwrap_or(ReplacedMaterials::All);
        files.mesh(&mesh.file(), covered);
        let frames = mesh.animation().into_iter().flat_map(|animation| animation.frame_files());
        frames.for_each(|file| files.add(AssetKind::MeshFrame, &file));
    }
    let textures = scene.textures.iter().filter(|t| !unused.textures.contains(&t.name.value));
    textures.for_each(|t| files.add(image(AssetKind::Texture, t.layer.as_ref()), &t.file));
    let materials = scene.materials.iter().filter(|m| !unused.materials.contains(&m.name.value));
    materials.for_each(|m| m.name_files(&mut files));
    let frames = scene.frames.iter().filter(|f| !unused.frames.contains(&f.name.value));
    frames.for_each(|f| motion_files(f.course.as_ref(), &mut files));
    scene.objects.iter().for_each(|o| motion_files(o.course.as_ref(), &mut files));
    scene.lights.iter().for_each(|l| light(l, &mut files));
    scene.media.iter().for_each(|m| m.name_files(&mut files));
    scene.environment.iter().for_each(|e| environment(e, &mut files));
    for (record, pose) in cameras {
        camera(record, &mut files);
        motion_files(pose.course.as_ref(), &mut files);
    }
    files.into_requests()
}

/// Materials of each mesh's file that all objects of the mesh override, by the mesh's name.
fn replaced_materials(scene: &Scene) -> BTreeMap<&str, ReplacedMaterials> {
    let mut covered: BTreeMap<&str, ReplacedMaterials> = BTreeMap::new();
    for object in &scene.objects {
        if let Body::Mesh(name) = &object.body {
            let before = covered.remove(name.as_str()).unwrap_or(ReplacedMaterials::All);
            covered.insert(name, before.and(replaced_by(object)));
        }
    }
    covered
}

/// Materials of the mesh's file that one object overrides.
fn replaced_by(object: &Object) -> ReplacedMaterials {
    match &object.material {
        Some(_) => ReplacedMaterials::All,
        None => ReplacedMaterials::Slots(object.materials.iter().map(|(slot, _)| slot.value.clone()).collect()),
    }
}

/// Returns every file that a camera names, each once.
#[must_use]
pub fn camera_files(camera: &Camera) -> Vec<AssetRequest> {
    let mut files = FileList::default();
    self::camera(camera, &mut files);
    files.into_requests()
}

/// Returns every file that a weather file names, each once.
#[must_use]
pub fn weather_files(weather: &Weather) -> Vec<AssetRequest> {
    let mut files = FileList::default();
    weather.name_files(&mut files);
    files.into_requests()
}

fn motion_files(motion_keys: Option<&MotionKeys>, files: &mut FileList) {
    let trajectory = motion_keys.and_then(|motion_keys| motion_keys.trajectory.as_ref());
    trajectory.into_iter().for_each(|trajectory| files.add(AssetKind::Trajectory, &trajectory.file));
}

fn light(light: &Light, files: &mut FileList) {
    motion_files(light.placement().and_then(|placement| placement.course.as_ref()), files);
    let mask = match light {
        Light::Sun(_) => None,
        Light::Point(lamp) => lamp.mask.as_ref(),
        Light::Spot(lamp) => lamp.mask.as_ref(),
        Light::Measured(lamp) => lamp.mask.as_ref(),
        Light::HeadLamp(lamp) => lamp.mask.as_ref(),
    };
    mask.into_iter().for_each(|mask| files.add(AssetKind::Image, &mask.file));
    if let Light::Measured(lamp) = light {
        files.add(AssetKind::Photometry, &lamp.file);
    }
    light.colour().into_iter().for_each(|colour| colour.name_files(files));
    light.modulation().into_iter().for_each(|modulation| modulation.name_files(files));
}

/// Kind of an image, or of one of its layers.
fn image(complete: AssetKind, layer: Option<&Placed<String>>) -> AssetKind {
    layer.map_or(complete, |layer| AssetKind::ImageLayer(layer.value.clone()))
}

fn environment(environment: &Environment, files: &mut FileList) {
    match environment {
        Environment::Uniform(emission) => emission.name_files(files),
        Environment::Image(environment) => {
            files.add(image(AssetKind::Image, environment.layer.as_ref()), &environment.file);
        }
        Environment::Sky(_) => {}
    }
}

fn lens(lens: &Lens, files: &mut FileList) {
    match lens {
        Lens::Pinhole(_) | Lens::Thin(_) | Lens::Thick(_) | Lens::Telecentric(_) => {}
        Lens::Prescription(lens) => {
            if let SurfaceListSource::File(file) = &lens.source {
                files.add(AssetKind::Prescription(lens.glass_files()), file);
            }
            lens.glasses.iter().for_each(|file| files.add(AssetKind::GlassCatalogue, file));
            if let Some(IrCutCurve::Spectrum(file)) = lens.ir_cut.as_ref().map(|filter| &filter.normal) {
                files.add(AssetKind::Spectrum(SpectrumValues::Share), file);
            }
        }
        Lens::RayTransfer(lens) => files.add(AssetKind::RayTransfer, &lens.file),
        Lens::Calibrated(lens) => {
            if let PixelDirections::Calibration(calibration) = &lens.view {
                files.add(AssetKind::Calibration(calibration.camera_in_file()), &calibration.file);
            }
            if let Some(file) = lens.view.projection_file() {
                files.add(AssetKind::LensTable(LensQuantity::Distortion), file);
            }
            if let Some(IlluminationSource::File(file)) = lens.relative_illumination.as_ref().map(|table| &table.source)
            {
                files.add(AssetKind::LensTable(LensQuantity::RelativeIllumination), file);
            }
        }
    }
}

fn front(front: &ExternalOptics, files: &mut FileList) {
    if let Some(glass) = &front.windscreen {
        glass.layers.iter().flatten().for_each(|layer| layer.index.name_file(SpectrumValues::Index, files));
        glass.internal_transmittance.name_files(files);
    }
    front.dirt.iter().for_each(|dirt| files.add(AssetKind::Image, &dirt.mask));
    if let Some(mirror) = &front.mirror {
        if let MirrorShape::Mesh(mesh) = &mirror.shape {
            files.mesh(&mesh.file, ReplacedMaterials::All);
        }
        match &mirror.finish {
            Finish::Share(colour) => colour.name_files(files),
            Finish::File(file) => files.add(AssetKind::ComplexIndex, file),
            Finish::Named(_) => {}
        }
    }
}

fn camera(camera: &Camera, files: &mut FileList) {
    lens(&camera.lens, files);
    camera.external_optics.iter().for_each(|f| front(f, files));
    let psf = camera.effects.as_ref().and_then(|effects| effects.psf.as_ref());
    psf.and_then(|psf| psf.image.as_ref()).into_iter().for_each(|image| files.add(AssetKind::Image, image));
    if let Some(ModulationSource::File(file)) = psf.and_then(|psf| psf.mtf.as_ref()).map(|table| &table.source) {
        files.add(AssetKind::LensTable(LensQuantity::Modulation), file);
    }
    psf.into_iter().flat_map(|psf| &psf.files).for_each(|file| files.add(AssetKind::PointSpread, file));
    camera.isp.iter().flat_map(Processing::files).for_each(|file| files.add(AssetKind::Numbers, file));
    match camera.sensor.electronics.as_ref().map(|e| &e.quantum_efficiency) {
        Some(QuantumEfficiency::Same(curve)) => curve.name_file(SpectrumValues::Share, files),
        Some(QuantumEfficiency::PerChannel(curves)) => {
            curves.iter().for_each(|c| c.name_file(SpectrumValues::Share, files));
        }
        Some(QuantumEfficiency::Named(list)) => {
            list.iter().for_each(|(_, c)| c.name_file(SpectrumValues::Share, files));
        }
        Some(QuantumEfficiency::Measured { .. }) | None => {}
    }
}
