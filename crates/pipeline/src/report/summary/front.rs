//! Text on the elements in front of a lens.

use super::{count, figure};
use etendue_core::maths::f64::acos;
use etendue_optics::front::{Cap, Course, Drops, Front, Mirror, MirrorShape, Optic, Reflectance, Windscreen};

/// The elements, and their omissions.
pub(super) fn front(front: &Front) -> Vec<String> {
    let dirt = front.dirt().map(|dirt| {
        let p = dirt.parameters();
        let distance = figure(p.placement.origin_mm.z);
        format!(
            "dirt, {distance} mm in front of the pupil: rays are weighted by the mask; light that it scatters is \
                 left out"
        )
    });
    dirt.into_iter().chain(optic(front)).collect()
}

fn optic(front: &Front) -> Vec<String> {
    match front.optic() {
        Some(Optic::Mirror(mirror)) => vec![
            format!("mirror, traced: {}; {}", shape(mirror), reflectance(mirror)),
            "left out: second reflections at the mirror, its roughness, the reflection of the camera body".to_owned(),
        ],
        Some(Optic::Windscreen(glass)) => {
            let traced = format!("windscreen, traced: {}", self::glass(glass));
            let left_out = "left out: further reflections in the glass, polarisation, glass edges; route = \"pupil\" \
                            is not available";
            [traced, left_out.to_owned()].into_iter().chain(glass.drops().into_iter().flat_map(drops)).collect()
        }
        None => Vec::new(),
    }
}

fn glass(glass: &Windscreen) -> String {
    let p = glass.parameters();
    let normal = p.placement.rotation.z_axis;
    let tilt = acos(normal.z.clamp(-1.0, 1.0)).to_degrees();
    let thick = figure(glass.thickness_mm());
    let light = match glass.axial_transmittances() {
        None => "not crossed by the axis".to_owned(),
        Some([straight, 0.0]) => format!("transmits {straight:.3} on the axis, no double image"),
        Some([straight, doubled]) => format!(
            "transmits {straight:.3} on the axis, and {doubled:.5} as a double image ({:.2} % of samples)",
            100.0 * glass.double_image_fraction()
        ),
    };
    let distance = figure(p.placement.origin_mm.z);
    format!(
        "{} of {thick} mm in total, {distance} mm in front of the pupil, {tilt:.1}° from the axis; {light}",
        super::count(p.layers.len(), "layer")
    )
}

fn shape(mirror: &Mirror) -> String {
    let parameters = mirror.parameters();
    let distance = figure(parameters.placement.origin_mm.z);
    match &parameters.shape {
        MirrorShape::Mesh(mesh) => {
            format!("{} with smooth normals, {distance} mm in front of the pupil", super::count(mesh.len(), "triangle"))
        }
        MirrorShape::Quadric(quadric) => {
            let reach = figure(quadric.rim_mm());
            let single = match quadric.outer_focus_mm() {
                Some(focus) if (focus - parameters.placement.origin_mm.z).abs() <= 1e-9 * focus => {
                    ", a single viewpoint"
                }
                _ => "",
            };
            format!(
                "{}, vertex {distance} mm in front of the pupil, edge {reach} mm from its axis{single}",
                quadric.name()
            )
        }
    }
}

fn reflectance(mirror: &Mirror) -> String {
    match mirror.reflectance() {
        Reflectance::Fraction(curve) => {
            let (low, high) = curve.range();
            match low == high {
                true => format!("reflectance {low}"),
                false => format!("reflectance {low:.3} to {high:.3}, depending on wavelength"),
            }
        }
        Reflectance::Metal(_) => "reflectance of a clean metal".to_owned(),
    }
}

/// The drops, and their omissions.
pub(super) fn drops(drops: &Drops) -> Vec<String> {
    let p = drops.parameters();
    let [smallest, greatest] = p.radius_mm.map(figure);
    let volume: f64 = drops.droplets().iter().map(|d| Cap::new(d.radius_mm, p.contact_angle_rad).volume_mm3()).sum();
    let largest = drops.droplets().iter().map(|d| d.radius_mm).fold(0.0, f64::max);
    let there = vec![
        format!(
            "water drops on the windscreen, traced: {} of {smallest} to {greatest} mm radius fell on {} × {} mm and \
             merged to {} of at most {} mm; contact angle {}°; they cover {:.2} % of this area and contain {:.1} µl",
            p.count,
            figure(p.size_mm.x),
            figure(p.size_mm.y),
            count(drops.droplets().len(), "drop"),
            figure(largest),
            figure(p.contact_angle_rad.to_degrees()),
            100.0 * drops.cover(),
            volume
        ),
        "left out: partial reflections at the drops, light through them from inside, wet trails, the effect of gravity \
         on their shape; ground truth excludes them"
            .to_owned(),
    ];
    there.into_iter().chain(p.course.as_ref().map(course)).collect()
}

/// Returns the changes of the drops over time, as text.
fn course(drop_motion: &Course) -> String {
    let Course { start_s, sliding, drying_s, arrivals_hz, wiper } = drop_motion;
    let sliding_text = sliding
        .map(|s| format!("slide at up to {} mm/s from {} mm radius", figure(s.speed_mm_s), figure(s.still_radius_mm)));
    let dry = drying_s.map(|s| format!("dry in {} s", figure(s)));
    let arrival_text = (*arrivals_hz > 0.0).then(|| format!("arrive at {} per second", figure(*arrivals_hz)));
    let wiper_text = wiper.map(|w| format!("are wiped every {} s from {} s", figure(w.period_s), figure(w.start_s)));
    let changes: Vec<String> = [sliding_text, dry, arrival_text, wiper_text].into_iter().flatten().collect();
    format!(
        "drops change from {} s on (figures above: at that time): they {}; each exposure uses their state at its \
         middle",
        figure(*start_s),
        changes.join(", ")
    )
}
