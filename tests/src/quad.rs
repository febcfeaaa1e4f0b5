//! A rectangle of a scene.

/// An object of a job: a rectangle of a size (m), in its own frame facing up, at a place (m) and turned (degrees).
#[must_use]
pub fn quad(name: &str, size_m: [f64; 2], at_m: [f64; 3], turn_deg: [f64; 3], material: &str) -> String {
    format!(
        "[[scene.objects]]\nname = \"{name}\"\nshape = {{ type = \"quad\", size_m = {size_m:?} }}\nmaterial = \"{material}\"\n\
         position_m = {at_m:?}\nrotation_deg = {turn_deg:?}\n"
    )
}
