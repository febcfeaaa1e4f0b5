//! Sizes of meshes as they stand in the scene, and warnings where the unit or the axes of a file are not those stated.

use crate::plan::Plan;
use crate::render::boxes::SolidBox;
use etendue_tracer::geometry::{MeshId, Shape};
use std::collections::BTreeMap;

/// Triangles of boxes, which have no file, at most: meshes of no more are not listed.
const OF_A_BOX: usize = 12;
/// Least and greatest plausible length of a road user, m.
const ROAD_USER_M: [f64; 2] = [0.01, 200.0];
/// Height over the longer side above which a vehicle stands on end.
const ON_END: f64 = 1.5;

/// Names of classes whose members use the road.
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
/// Those of them that are longer or wider than high.
const LONG: [&str; 9] = ["bus", "car", "caravan", "train", "tram", "trailer", "truck", "van", "lorry"];

/// A mesh as it stands in the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshSize {
    /// The first object that it is the shape of.
    pub object: String,
    /// Objects that it is the shape of.
    pub objects: usize,
    /// Its triangles.
    pub triangles: usize,
    /// Length, width and height of the first object along its own axes (x forward, y left, z up), m.
    pub size_m: [f64; 3],
}

/// The meshes that are the shape of named objects, in the order of the first object of each; boxes and flat shapes are left out.
#[must_use]
pub fn mesh_sizes(plan: &Plan) -> Vec<MeshSize> {
    let mut places: BTreeMap<MeshId, usize> = BTreeMap::new();
    let mut found: Vec<MeshSize> = Vec::new();
    for instance in plan.world.instances() {
        let Shape::Mesh(id) = instance.shape else { continue };
        let identity = (instance.instance_id as usize).checked_sub(1).and_then(|place| plan.identities.get(place));
        let (Some(identity), triangles) = (identity, plan.world.mesh(id).triangles().len()) else { continue };
        if triangles <= OF_A_BOX {
            continue;
        }
        let place = *places.entry(id).or_insert_with(|| {
            let (size, _) = SolidBox::in_world(plan, instance, 0.0);
            found.push(MeshSize { object: identity.name.clone(), objects: 0, triangles, size_m: size.to_array() });
            found.len() - 1
        });
        found[place].objects += 1;
    }
    found
}

/// Warnings of road users that are too small or too large, or of vehicles that stand on end.
pub(super) fn warnings(plan: &Plan) -> Vec<String> {
    let mut found = Vec::new();
    for instance in plan.world.instances() {
        let identity = (instance.instance_id as usize).checked_sub(1).and_then(|place| plan.identities.get(place));
        let Some((identity, class)) = identity.and_then(|identity| Some((identity, identity.class.as_ref()?))) else {
            continue;
        };
        let class = class.to_lowercase().replace([' ', '_'], "-");
        if !ROAD_USERS.contains(&class.as_str()) {
            continue;
        }
        let (size, _) = SolidBox::in_world(plan, instance, 0.0);
        let [length, width, height] = size.to_array();
        let measures = format!("{length:.4} × {width:.4} × {height:.4} m (length, width, height)");
        let longest = size.max_element();
        let name = &identity.name;
        if !(ROAD_USER_M[0]..=ROAD_USER_M[1]).contains(&longest) {
            found.push(format!(
                "{name}: a {class} of {measures}: check the scale of its mesh, which is metres per unit of the file"
            ));
        } else if LONG.contains(&class.as_str()) && height > ON_END * length.max(width) {
            found.push(format!(
                "{name}: a {class} that stands on end, {measures}: check up_axis and forward_axis of its mesh"
            ));
        }
    }
    found
}
