//! All objects of the world at a moment, whether a camera sees them or not.

use super::{SolidBox, Stance};
use crate::plan::Plan;
use etendue_tracer::geometry::Instance;
use glam::DVec3;

/// An object of the world at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct WorldObject {
    /// Its identity in the ground truth.
    pub id: u32,
    /// Its name in the scene.
    pub name: String,
    /// Its class; `None`: it has none.
    pub class: Option<String>,
    /// Lengths of its box along its own axes x, y, z, m.
    pub size_m: DVec3,
    /// Where its box stands in the world.
    pub stance: Stance,
    /// Velocity of the box's centre in the world, m/s, by the object's motion; what a mesh deforms is left out.
    pub velocity_m_s: DVec3,
    /// Whether it ever moves.
    pub moves: bool,
}

/// The objects with an identity at a simulated time, s, in the order of their identities.
#[must_use]
pub fn world_objects(plan: &Plan, time_s: f64) -> Vec<WorldObject> {
    let numbered = plan.world.instances().iter().filter(|instance| instance.instance_id > 0);
    let mut objects: Vec<WorldObject> = numbered.filter_map(|instance| object(plan, instance, time_s)).collect();
    objects.sort_by_key(|object| object.id);
    objects
}

fn object(plan: &Plan, instance: &Instance, time_s: f64) -> Option<WorldObject> {
    let identity = plan.identity(instance.instance_id)?;
    let (size_m, stance) = SolidBox::in_world(plan, instance, time_s);
    let centre = instance.to_world.at(time_s).inverse().transform_point3(stance.centre_m);
    Some(WorldObject {
        id: instance.instance_id,
        name: identity.name.clone(),
        class: identity.class.clone(),
        size_m,
        stance,
        velocity_m_s: instance.to_world.velocity_at(time_s, centre),
        moves: instance.to_world.as_still().is_none(),
    })
}
