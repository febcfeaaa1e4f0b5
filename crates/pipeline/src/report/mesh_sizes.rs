//! Sizes of meshes in the scene, and warnings if the unit or the axes of a file seem not to be those stated.

use crate::plan::Plan;
use crate::render::boxes::SolidBox;
use etendue_tracer::geometry::{MeshId, Shape};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Maximum triangles of a box, which has no file: meshes of no more triangles are not listed.
const OF_A_BOX: usize = 12;
/// Minimum and maximum plausible length of a road user, m.
const ROAD_USER_M: [f64; 2] = [0.01, 200.0];
/// Ratio of height to the longer side above which a vehicle is considered upended.
const UPENDED_RATIO: f64 = 1.5;

/// Names of the classes of road users.
const ROAD_USERS: [&str; 22] = [
    "animal",
    "bicycle",
    "bus",
    "car",
    "caravan",
    "cyclist",
    "motorbike",
    "motorcycle",
    "pedestrian",
    "people",
    "person",
    "person-sitting",
    "rider",
    "scooter",
    "train",
    "tram",
    "trailer",
    "truck",
    "van",
    "vehicle",
    "lorry",
    "emergency-vehicle",
];
/// Those of them that are longer or wider than they are high.
const LONG_ROAD_USERS: [&str; 9] = ["bus", "car", "caravan", "train", "tram", "trailer", "truck", "van", "lorry"];

/// A mesh in the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSize {
    /// The first object with this mesh.
    pub object: String,
    /// Number of objects with this mesh.
    pub objects: usize,
    pub triangles: usize,
    /// Length, width and height of the first object along its own axes (x forward, y left, z up), m.
    pub size_m: [f64; 3],
}

/// Meshes of named objects, in the order of the first object of each; boxes and flat shapes are omitted.
#[must_use]
pub fn mesh_sizes(plan: &Plan) -> Vec<MeshSize> {
    let mut places: BTreeMap<MeshId, usize> = BTreeMap::new();
    let mut sizes: Vec<MeshSize> = Vec::new();
    for instance in plan.world.instances() {
        let Shape::Mesh(id) = instance.shape else { continue };
        let Some(identity) = plan.identity(instance.instance_id) else { continue };
        let triangles = plan.world.mesh(id).triangles().len();
        if triangles <= OF_A_BOX {
            continue;
        }
        let place = *places.entry(id).or_insert_with(|| {
            let (size, _) = SolidBox::in_world(plan, instance, 0.0);
            sizes.push(MeshSize { object: identity.name.clone(), objects: 0, triangles, size_m: size.to_array() });
            sizes.len() - 1
        });
        sizes[place].objects += 1;
    }
    sizes
}

/// Warnings of road users that are too small or too large, and of upended vehicles: for each shape and class the first object.
pub(super) fn warnings(plan: &Plan) -> Vec<String> {
    let (mut listed, mut reported) = (Vec::new(), BTreeSet::new());
    for instance in plan.world.instances() {
        let Some(identity) = plan.identity(instance.instance_id) else { continue };
        let Some(class) = identity.class.as_ref().map(|class| class.to_lowercase().replace([' ', '_'], "-")) else {
            continue;
        };
        let mesh = match instance.shape {
            Shape::Mesh(id) => Some(id),
            Shape::Sphere { .. } => None,
        };
        if !ROAD_USERS.contains(&class.as_str()) || !reported.insert((mesh, class.clone())) {
            continue;
        }
        let (size_m, _) = SolidBox::in_world(plan, instance, 0.0);
        listed.extend(implausible_size(&class, size_m).map(|problem| format!("{}: {problem}", identity.name)));
    }
    listed
}

/// Describes an implausible size of a road user along its own axes, m.
fn implausible_size(class: &str, size_m: DVec3) -> Option<String> {
    let DVec3 { x: length, y: width, z: height } = size_m;
    let measures = format!("{length:.4} × {width:.4} × {height:.4} m (length, width, height)");
    if !(ROAD_USER_M[0]..=ROAD_USER_M[1]).contains(&size_m.max_element()) {
        return Some(format!("a {class} of {measures}: check the scale of its mesh (metres per unit of the file)"));
    }
    let is_on_end = LONG_ROAD_USERS.contains(&class) && height > UPENDED_RATIO * length.max(width);
    is_on_end
        .then(|| format!("a {class} higher than long and wide, {measures}: check up_axis and forward_axis of its mesh"))
}
