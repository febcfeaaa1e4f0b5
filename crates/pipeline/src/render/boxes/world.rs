//! All objects of the world at a time, visible to a camera or not.

use super::{BoxPose, SolidBox};
use crate::plan::Plan;
use etendue_tracer::geometry::Instance;
use glam::DVec3;

/// An object of the world at a time.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldObject {
    /// Instance id in the ground truth.
    pub id: u32,
    /// Its name in the scene.
    pub name: String,
    /// Its class, if any.
    pub class: Option<String>,
    /// Lengths of its box along its own axes x, y, z, m.
    pub size_m: DVec3,
    /// Pose of its box in the world.
    pub pose: BoxPose,
    /// Velocity of the box's centre in the world, m/s, by the object's motion, without deformation of a mesh.
    pub velocity_m_s: DVec3,
    /// True if it moves at any time.
    pub moves: bool,
}

/// Objects with an identity at a simulated time, s, in the order of their identities.
#[must_use]
pub fn world_objects(plan: &Plan, time_s: f64) -> Vec<WorldObject> {
    let numbered = plan.world.instances().iter().filter(|instance| instance.instance_id > 0);
    let mut objects: Vec<WorldObject> = numbered.filter_map(|instance| object(plan, instance, time_s)).collect();
    objects.sort_by_key(|object| object.id);
    objects
}

fn object(plan: &Plan, instance: &Instance, time_s: f64) -> Option<WorldObject> {
    let identity = plan.identity(instance.instance_id)?;
    let (size_m, pose) = SolidBox::in_world(plan, instance, time_s);
    let centre = instance.to_world.at(time_s).inverse().transform_point3(pose.centre_m);
    Some(WorldObject {
        id: instance.instance_id,
        name: identity.name.clone(),
        class: identity.class.clone(),
        size_m,
        pose,
        velocity_m_s: instance.to_world.velocity_at(time_s, centre),
        moves: instance.to_world.as_constant().is_none(),
    })
}
