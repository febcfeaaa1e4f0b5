//! What is said of the things in front of a lens.

use super::drops;
use etendue_core::maths::f64::acos;
use etendue_optics::front::{Front, Mirror, MirrorShape, Optic, Reflectance, Windscreen};

/// What stands there, and what of it is left out.
pub(super) fn front(front: &Front) -> Vec<String> {
    let dirt = front.dirt().map(|dirt| {
        let p = dirt.parameters();
        let distance = super::figure(p.placement.origin_mm.z);
        format!("dirt, {distance} mm before the pupil: each ray by the mask; light that it scatters is left out")
    });
    dirt.into_iter().chain(optic(front)).collect()
}

fn optic(front: &Front) -> Vec<String> {
    match front.optic() {
        Some(Optic::Mirror(mirror)) => vec![
            format!("a mirror, traced: {}; {}", shape(mirror), reflectance(mirror)),
            "left out: second reflections at the mirror, its roughness, the body of the camera in it".to_owned(),
        ],
        Some(Optic::Windscreen(glass)) => {
            let traced = format!("a wind-screen, traced: {}", self::glass(glass));
            let left_out =
                "left out: further reflections in the glass, polarisation, its edges; the route at the pupil";
            [traced, left_out.to_owned()].into_iter().chain(glass.drops().into_iter().flat_map(drops::drops)).collect()
        }
        None => Vec::new(),
    }
}

fn glass(glass: &Windscreen) -> String {
    let p = glass.parameters();
    let normal = p.placement.rotation.z_axis;
    let tilt = acos(normal.z.clamp(-1.0, 1.0)).to_degrees();
    let thick = super::figure(glass.thickness_mm());
    let light = match glass.axial_transmittances() {
        None => "not met by the axis".to_owned(),
        Some([straight, 0.0]) => format!("lets through {straight:.3} on the axis, no double image"),
        Some([straight, doubled]) => format!(
            "lets through {straight:.3} on the axis, and {doubled:.5} as a double image ({:.2} % of samples)",
            100.0 * glass.double_image_fraction()
        ),
    };
    let distance = super::figure(p.placement.origin_mm.z);
    format!(
        "{} of {thick} mm, {distance} mm before the pupil, {tilt:.1}° from the axis; {light}",
        super::count(p.layers.len(), "layer")
    )
}

fn shape(mirror: &Mirror) -> String {
    let parameters = mirror.parameters();
    let distance = super::figure(parameters.placement.origin_mm.z);
    match &parameters.shape {
        MirrorShape::Mesh(mesh) => {
            format!("{} with smooth normals, {distance} mm before the pupil", super::count(mesh.len(), "triangle"))
        }
        MirrorShape::Quadric(quadric) => {
            let reach = super::figure(quadric.rim_mm());
            let single = match quadric.outer_focus_mm() {
                Some(focus) if (focus - parameters.placement.origin_mm.z).abs() <= 1e-9 * focus => {
                    ", a single viewpoint"
                }
                _ => "",
            };
            format!(
                "{}, its vertex {distance} mm before the pupil, its rim {reach} mm from its axis{single}",
                quadric.name()
            )
        }
    }
}

fn reflectance(mirror: &Mirror) -> String {
    match mirror.reflectance() {
        Reflectance::Share(curve) => {
            let (low, high) = curve.range();
            match low == high {
                true => format!("reflects {low}"),
                false => format!("reflects {low:.3} to {high:.3} by wavelength"),
            }
        }
        Reflectance::Metal(_) => "reflects as a clean metal".to_owned(),
    }
}
