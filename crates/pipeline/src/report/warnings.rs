//! Warnings of a plan that a render repeats: reasons for which the image may differ from the user's intent.

use crate::plan::note::{Severity, grouped};
use crate::plan::{CameraPlan, Plan, Route};
use crate::render::{light_counts, surrounding_object};
use crate::report::mesh_sizes;
use crate::report::summary::lens::field_of_view_rad;
use etendue_optics::{DepthOfField, Lens};

impl Plan {
    /// Warnings that concern the image, each a sentence without a full stop: those of the remarks, of each camera that receives no light, of extreme fields
    /// of view, of each camera inside an object or with an obscuration that its route leaves out, and of road users of implausible size.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let listed = self.description_warnings().into_iter();
        let extreme = self.cameras.iter().filter_map(extreme_field);
        let inside = self.cameras.iter().filter_map(|camera| self.inside(camera));
        let filled = self.cameras.iter().filter_map(filled_obscuration);
        let of_cameras = self.dark_cameras().into_iter().chain(extreme).chain(inside).chain(filled);
        listed.chain(of_cameras).chain(mesh_sizes::warnings(self)).collect()
    }

    /// Warnings of the remarks alone: those of the description and its files, which hold without an image.
    #[must_use]
    pub fn description_warnings(&self) -> Vec<String> {
        let groups = grouped(&self.notes).into_iter().filter(|group| group.weight == Severity::Warning);
        groups.map(|group| group.to_string()).collect()
    }

    fn inside(&self, camera: &CameraPlan) -> Option<String> {
        let object = surrounding_object(self, camera)?;
        Some(format!(
            "camera {}: it is inside the object {object} and sees only the inside of its surface",
            camera.name
        ))
    }

    fn dark_cameras(&self) -> Option<String> {
        let dark = self.cameras.iter().filter(|camera| light_counts(self, camera).is_dark());
        let names: Vec<&str> = dark.map(|camera| camera.name.as_str()).collect();
        let message = format!("camera {}: there is no light, so the image will be black", names.join(", "));
        (!names.is_empty()).then_some(message)
    }
}

/// Warns of defocus by the whole pupil where it is a ring.
fn filled_obscuration(camera: &CameraPlan) -> Option<String> {
    let blurs = matches!(camera.settings.route, Route::Pupil(_)) && camera.depth_of_field == DepthOfField::Physical;
    (blurs && camera.body.lens.obscured_ratio() > 0.0).then(|| {
        let name = &camera.name;
        format!(
            "camera {name}: the pupil route blurs with the whole pupil, without its central obscuration: unfocused points become discs, not \
             rings; route = \"lens\" has the rings"
        )
    })
}

/// Implausible fields of view of perspective lenses, degrees: below the first or above the second.
const PLAUSIBLE_FIELD_DEG: [f64; 2] = [0.2, 175.0];

/// Warns of a perspective field of view that results from a focal length or pitch in another unit.
fn extreme_field(camera: &CameraPlan) -> Option<String> {
    if !matches!(camera.body.lens, Lens::Pinhole(_) | Lens::Thin(_)) {
        return None;
    }
    let angle_deg = field_of_view_rad(camera)?.to_degrees();
    let [min_deg, max_deg] = PLAUSIBLE_FIELD_DEG;
    (angle_deg < min_deg || angle_deg > max_deg).then(|| {
        let name = &camera.name;
        format!(
            "camera {name}: the field of view is {angle_deg:.4}°; check the focal length (mm) and the pixel pitch (µm)"
        )
    })
}
