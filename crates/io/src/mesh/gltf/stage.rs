//! Lights and cameras of a glTF file, with their transforms.
//!
//! Source: glTF 2.0 Specification, 3.10 (cameras), and KHR_lights_punctual.

use std::path::Path;

use glam::DAffine3;
use gltf::json::extensions::scene::khr_lights_punctual::{Light, Type};
use gltf::{json::Root, json::validation::Checked};

use super::{document, nodes};
use crate::{Error, Problem, source::read_bytes};

/// Lights and cameras of a glTF file, in its axes (+y up, +z forward; m).
#[derive(Clone, Debug, Default)]
pub struct GltfStage {
    /// The lights of the scene's nodes.
    pub lights: Vec<GltfLight>,
    /// The cameras of the scene's nodes.
    pub cameras: Vec<GltfCamera>,
    /// Nodes of the scene that show a mesh, by their numbers in the file.
    pub mesh_nodes: Vec<usize>,
    /// Number of animations.
    pub animations: usize,
}

/// Punctual light.
#[derive(Clone, Debug)]
pub struct GltfLight {
    /// Name, or its node's; empty if neither has one.
    pub name: String,
    /// Number of its node in the file.
    pub node: usize,
    /// Transform from its own axes, in which it shines along −z, to the file's.
    pub to_file: DAffine3,
    /// Kind and emission cone.
    pub kind: GltfLightKind,
    /// Linear sRGB, 0 or more.
    pub colour: [f64; 3],
    /// Intensity of a white light, cd; for a directional light illuminance, lx.
    pub intensity: f64,
    /// True if the file limits its range.
    pub has_range: bool,
}

/// Kind of a punctual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GltfLightKind {
    /// Parallel light from infinity.
    Directional,
    /// Isotropic.
    Point,
    /// Cone.
    Spot {
        /// Half angle of full intensity, rad.
        inner_rad: f64,
        /// Half angle beyond which it is dark, rad.
        outer_rad: f64,
    },
}

#[derive(Clone, Debug)]
pub struct GltfCamera {
    /// Name, or its node's; empty if neither has one.
    pub name: String,
    /// Number of its node in the file.
    pub node: usize,
    /// Transform from its own axes, in which it looks along −z with +y up, to the file's.
    pub to_file: DAffine3,
    pub projection: GltfProjection,
}

/// Projection of a camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GltfProjection {
    /// Rectilinear.
    Perspective {
        /// Full vertical angle, rad.
        yfov_rad: f64,
        /// Width over height; `None` if the file leaves it to the viewer.
        aspect: Option<f64>,
    },
    /// Parallel.
    Orthographic {
        /// Half of the visible width and height, m.
        half_m: [f64; 2],
    },
}

/// Reads lights and cameras of a glTF file. Its buffers, which do not describe them, are not read.
///
/// # Errors
/// Damaged files, or illegal numbers of a light or camera.
pub fn read_gltf_stage(file: &Path) -> Result<GltfStage, Error> {
    let bytes = read_bytes(file, "scene")?;
    read(&bytes).map_err(|problem| Error::new(file, problem))
}

fn read(bytes: &[u8]) -> Result<GltfStage, Problem> {
    let (root, _) = document::parse(bytes)?;
    let (shown, to_file) = nodes::visible_nodes(&root)?;
    let mut stage = GltfStage { animations: root.animations.len(), ..GltfStage::default() };
    for number in shown {
        let (node, to_file) = (&root.nodes[number], to_file[number]);
        let node_name = node.name.clone().unwrap_or_default();
        stage.mesh_nodes.extend(node.mesh.map(|_| number));
        if let Some(light) = node.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref()) {
            stage.lights.push(light_of(&root, light.light.value(), number, node_name.clone(), to_file)?);
        }
        if let Some(camera) = node.camera {
            stage.cameras.push(camera_of(&root, camera.value(), number, node_name, to_file)?);
        }
    }
    Ok(stage)
}

fn light_of(
    root: &Root,
    number: usize,
    node: usize,
    node_name: String,
    to_file: DAffine3,
) -> Result<GltfLight, Problem> {
    let lights = root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    let light = lights
        .and_then(|l| l.lights.get(number))
        .ok_or_else(|| format!("a node refers to light {number}, which does not exist; export the file again"))?;
    let wrong = |problem: Problem| problem.within(format_args!("light {number}"));
    let legal = |v: f64| v.is_finite() && v >= 0.0;
    let (colour, intensity) = (light.color.map(f64::from), f64::from(light.intensity));
    if !legal(intensity) || !colour.iter().all(|v| legal(*v)) {
        return Err(wrong("intensity and colour must be finite numbers of 0 or more; correct the model".into()));
    }
    Ok(GltfLight {
        name: light.name.clone().unwrap_or(node_name),
        node,
        to_file,
        kind: kind_of(light).map_err(wrong)?,
        colour,
        intensity,
        has_range: light.range.is_some(),
    })
}

fn kind_of(light: &Light) -> Result<GltfLightKind, Problem> {
    match (&light.type_, &light.spot) {
        (Checked::Valid(Type::Directional), _) => Ok(GltfLightKind::Directional),
        (Checked::Valid(Type::Point), _) => Ok(GltfLightKind::Point),
        (Checked::Valid(Type::Spot), Some(spot)) => {
            let (inner_rad, outer_rad) = (f64::from(spot.inner_cone_angle), f64::from(spot.outer_cone_angle));
            // π/2 rounded to 32 bits may exceed it.
            let max = std::f64::consts::FRAC_PI_2 + 1e-6;
            match inner_rad >= 0.0 && inner_rad < outer_rad && outer_rad <= max {
                true => Ok(GltfLightKind::Spot { inner_rad, outer_rad }),
                false => {
                    Err(format!("the cone angles are {inner_rad} and {outer_rad}; expected 0 ≤ inner < outer ≤ π/2")
                        .into())
                }
            }
        }
        _ => Err("unknown type; expected directional, point, or spot with its angles".into()),
    }
}

fn camera_of(
    root: &Root,
    number: usize,
    node: usize,
    node_name: String,
    to_file: DAffine3,
) -> Result<GltfCamera, Problem> {
    let camera = root
        .cameras
        .get(number)
        .ok_or_else(|| format!("a node refers to camera {number}, which does not exist; export the file again"))?;
    let above = |v: f32, what: &str| match v > 0.0 && v.is_finite() {
        true => Ok(f64::from(v)),
        false => Err(format!("camera {number}: {what} is {v}; expected a number above 0")),
    };
    let projection = match (&camera.perspective, &camera.orthographic) {
        (Some(p), _) => {
            let yfov_rad = above(p.yfov, "yfov")?;
            if yfov_rad >= 3.0 {
                return Err(format!("camera {number}: yfov is {yfov_rad} rad; expected less than 3 rad").into());
            }
            let aspect = p.aspect_ratio.map(|a| above(a, "aspectRatio")).transpose()?;
            GltfProjection::Perspective { yfov_rad, aspect }
        }
        (None, Some(o)) => {
            GltfProjection::Orthographic { half_m: [above(o.xmag.abs(), "xmag")?, above(o.ymag.abs(), "ymag")?] }
        }
        (None, None) => return Err(format!("camera {number} has no projection; export the file again").into()),
    };
    Ok(GltfCamera { name: camera.name.clone().unwrap_or(node_name), node, to_file, projection })
}
