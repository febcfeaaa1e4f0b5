//! Whose light a camera sees, and why one that looks the same way has its own.

use super::list;
use crate::plan::shared_light::why_apart;
use crate::plan::{CameraPlan, Plan};

/// The camera of the plan whose film serves this one, where that is another.
pub(super) fn server<'a>(plan: &'a Plan, camera: &CameraPlan) -> Option<&'a CameraPlan> {
    plan.cameras.iter().find(|other| other.light == camera.light).filter(|other| other.index != camera.index)
}

/// What is said of a camera's light; `None` where it is its own and no other camera's is nearly the same.
pub(super) fn light(plan: &Plan, camera: &CameraPlan) -> Option<String> {
    if !camera.owns_light() {
        let owner = &camera.light.camera;
        return Some(match server(plan, camera) {
            Some(_) => format!("that of camera {owner}, with its errors: light is equal and rendered once"),
            None => format!("equal to that of camera {owner} of the job, whose random numbers it has"),
        });
    }
    why_apart(plan, camera)
        .map(|(other, unlike)| format!("its own: camera {other} looks the same way, but differs in {}", list(&unlike)))
}

/// The cameras that a film serves beside its own, as a part of a sentence.
pub(super) fn served(plan: &Plan, camera: &CameraPlan) -> String {
    let others: Vec<&str> = plan
        .cameras
        .iter()
        .filter(|other| other.light == camera.light && other.index != camera.index)
        .map(|other| other.name.as_str())
        .collect();
    match others.len() {
        0 => String::new(),
        1..=4 => format!(", for {} too", list(&others)),
        n => format!(", for {n} more cameras too: {} to {}", others[0], others[n - 1]),
    }
}
