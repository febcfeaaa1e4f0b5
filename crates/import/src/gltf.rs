//! Import of glTF files: the mesh is referenced unchanged; lights, cameras and animated nodes are converted to our keys.

use std::path::Path;

use etendue_io::failure::{Error, ErrorCode};
use etendue_io::mesh::{
    GltfCamera, GltfLight, GltfLightKind, GltfMotion, GltfProjection, GltfStage, read_gltf_motion, read_gltf_stage,
    read_mesh,
};
use etendue_scene::asset::{MeshAsset, SlotSurface};
use etendue_scene::record::{Body, Light, LightColour, Mesh, Object, Pose, Scene, Transform};
use etendue_spectra::colour::BT709;
use glam::{DAffine3, DVec3};

use super::lamps;
use super::moving::{MovingNodes, add_moving, part_of, to_world};
use super::naming::{UniqueNames, path_between};
use super::substitutes::{even_sky, whole_view};
use super::written::{ImportFiles, ImportedCamera, View, import_files, pose_of, size_of};

pub(super) fn convert(file: &Path, folder: &Path) -> Result<ImportFiles, Error> {
    let stage = read_gltf_stage(file).map_err(Error::input)?;
    let motion = read_gltf_motion(file).map_err(Error::input)?;
    let (mut report, mut files) = (Vec::new(), Vec::new());
    let mut scene = Scene::default();
    let mesh = if stage.mesh_nodes.is_empty() { None } else { Some(read_mesh(file).map_err(Error::input)?) };
    let still = stage.mesh_nodes.iter().any(|node| motion.parts.mover_of[*node].is_none());
    // The static part has the name of the file, and "still" in its part file name: no moving part may have that name.
    let mut names = UniqueNames::default();
    let mut still_name = String::new();
    if still {
        let stem = file.file_stem().unwrap_or_default().to_string_lossy();
        still_name = names.take(&stem, "model");
        names.take("still", "still");
    }
    let moving = add_moving(&mut scene, &motion, file, folder, &mut names, &mut files, &mut report)
        .map_err(|problem| Error::coded(ErrorCode::MalformedFile, format!("{}: {problem}", file.display())))?;
    match (mesh.is_some(), still, motion.animated_nodes.is_empty()) {
        (false, ..) => report.push("it has no meshes".to_owned()),
        (true, false, _) => report.push("all its meshes move".to_owned()),
        (true, true, true) => {
            let path = path_between(folder, file).to_string_lossy().into_owned();
            add_still(&mut scene, &still_name, &path, &mut report);
        }
        (true, true, false) => {
            let part = "meshes/still.gltf".to_owned();
            files.push((part.clone(), part_of(&motion, None, file, folder)));
            add_still(&mut scene, &still_name, &part, &mut report);
        }
    }
    report.extend(motion.notes.iter().cloned());
    let mut light_names = UniqueNames::default();
    let node_frames = NodeFrames { motion: &motion, moving: &moving };
    for light in &stage.lights {
        scene.lights.extend(light_of(light, &node_frames, &mut light_names, &mut report));
    }
    if scene.lights.is_empty() && !mesh.as_ref().is_some_and(emits_light) {
        report.push(even_sky(&mut scene));
    }
    let cameras = cameras_of(&stage, &node_frames, mesh.as_ref(), &mut report);
    let mut result = import_files(file, &scene, &cameras, report);
    result.files.extend(files);
    Ok(result)
}

/// Adds the mesh of the static part, in a file at the path `way`.
fn add_still(scene: &mut Scene, name: &str, path: &str, report: &mut Vec<String>) {
    scene.meshes.push(Mesh::new(name, path));
    scene.objects.push(Object::new(name, Body::Mesh(name.into()), Transform::default()));
    report.push(format!("its meshes: object \"{name}\"; the plan lists its materials and textures"));
}

/// State for lights and cameras: the moving frames.
struct NodeFrames<'a> {
    motion: &'a GltfMotion,
    moving: &'a MovingNodes,
}

impl NodeFrames<'_> {
    /// Frame of the content of a node, and the transform from its axes to those of the frame; in the file's axes.
    fn place(&self, node: usize, to_file: DAffine3) -> (Option<String>, DAffine3) {
        let Some(mover) = self.motion.parts.mover_of[node] else { return (None, to_file) };
        let (name, scale) = self.moving.frame(mover);
        let own = self.motion.animated_nodes[mover].to_file.inverse() * to_file;
        (Some(name.to_owned()), DAffine3::from_scale(DVec3::splat(scale)) * own)
    }
}

fn emits_light(mesh: &MeshAsset) -> bool {
    let emits = |surface: &SlotSurface| matches!(surface, SlotSurface::Layers(layers) if layers.emission.is_some());
    mesh.slot_materials.iter().any(|slot| slot.surface.as_ref().is_some_and(emits))
}

/// `None` for a light of zero intensity.
fn light_of(
    light: &GltfLight,
    node_frames: &NodeFrames<'_>,
    names: &mut UniqueNames,
    report: &mut Vec<String>,
) -> Option<Light> {
    let name = names.take(&light.name, "light");
    // The specification multiplies linear sRGB by the intensity: a coloured light has the luminance of its colour times that of a white one.
    let luminance: f64 = light.colour.iter().zip(BT709).map(|(v, weight)| v * weight).sum();
    let level = light.intensity * luminance;
    if level <= 0.0 {
        report.push(format!("light \"{name}\" emits no light and is left out"));
        return None;
    }
    let note = |kind: &str, unit: &str| {
        let range = if light.has_range { "; its range is not used: light is not cut off" } else { "" };
        format!("light \"{name}\", {kind}: {level} {unit}{range}")
    };
    let colour = LightColour::Rgb(light.colour.into());
    let (frame, place) = node_frames.place(light.node, light.to_file);
    let position = to_world(place.translation);
    let ahead = to_world(place.matrix3 * DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
    let converted = match light.kind {
        GltfLightKind::Point => {
            report.push(note("point", "cd"));
            lamps::point(&name, position, level, colour)
        }
        GltfLightKind::Spot { inner_rad, outer_rad } => {
            report.push(note("spot, with Étendue's falloff curve between the same angles", "cd"));
            // 90° rounded to 32 bits may exceed it.
            let half_deg = [inner_rad, outer_rad].map(|rad| rad.to_degrees().min(90.0));
            lamps::spot(&name, position, ahead, half_deg, level, colour)
        }
        GltfLightKind::Directional => {
            report.push(note("directional: a sun disc of 0.01°", "lx"));
            if frame.is_some() {
                report.push(format!("light \"{name}\" does not move: a sun is static"));
            }
            let ahead = to_world(light.to_file.matrix3 * DVec3::NEG_Z).normalize_or(DVec3::NEG_Z);
            lamps::parallel(&name, -ahead, level, colour)
        }
    };
    Some(lamps::in_frame(converted, frame))
}

fn cameras_of(
    stage: &GltfStage,
    node_frames: &NodeFrames<'_>,
    mesh: Option<&MeshAsset>,
    report: &mut Vec<String>,
) -> Vec<ImportedCamera> {
    let mut names = UniqueNames::default();
    let cameras: Vec<ImportedCamera> =
        stage.cameras.iter().map(|camera| camera_of(camera, node_frames, &mut names, report)).collect();
    match (cameras.is_empty(), mesh) {
        (true, mesh) => {
            report.push("it has no cameras: \"view\" is added, which shows the whole scene from the front".to_owned());
            vec![view_of(mesh)]
        }
        _ => cameras,
    }
}

fn camera_of(
    camera: &GltfCamera,
    node_frames: &NodeFrames<'_>,
    names: &mut UniqueNames,
    report: &mut Vec<String>,
) -> ImportedCamera {
    let name = names.take(&camera.name, "camera");
    let (view, aspect, message) = match camera.projection {
        GltfProjection::Perspective { yfov_rad, aspect } => {
            let message = format!("perspective, vertical field of view {:.4}°", yfov_rad.to_degrees());
            (View::Perspective { yfov_rad }, aspect, message)
        }
        GltfProjection::Orthographic { half_m: [x, y] } => {
            (View::Orthographic { width_m: 2.0 * x }, Some(x / y), format!("orthographic, {} m wide", 2.0 * x))
        }
    };
    let free = if aspect.is_none() { "; its aspect ratio is not stated and is set to 4:3" } else { "" };
    report.push(format!("camera \"{name}\": {message}{free}; its near and far planes are not used"));
    // The scale of its node is ignored.
    let (frame, place) = node_frames.place(camera.node, camera.to_file);
    let axis = |v: DVec3| to_world(place.matrix3 * v);
    let pose = pose_of(to_world(place.translation), axis(DVec3::NEG_Z), axis(DVec3::Y));
    let pose = Pose { frame: frame.map(|frame| frame.as_str().into()), ..pose };
    ImportedCamera { name, pose, view, size_px: size_of(aspect.unwrap_or(4.0 / 3.0)) }
}

/// View of the whole mesh, from the front and above.
fn view_of(mesh: Option<&MeshAsset>) -> ImportedCamera {
    let places = || mesh.iter().flat_map(|m| m.positions.iter().map(|p| (m.origin, p)));
    let world =
        |(origin, p): ([f64; 3], &[f32; 3])| to_world(DVec3::from_array(origin) + DVec3::from_array(p.map(f64::from)));
    let bound = |pick: fn(DVec3, DVec3) -> DVec3| places().map(world).reduce(pick).unwrap_or(DVec3::ZERO);
    whole_view(bound(DVec3::min), bound(DVec3::max))
}
