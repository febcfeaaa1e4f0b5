//! What is said of drops of water on a wind-screen.

use super::{count, figure};
use etendue_optics::front::{Cap, Course, Drops};

/// What lies there, and what of it is left out.
pub(super) fn drops(drops: &Drops) -> Vec<String> {
    let p = drops.parameters();
    let [least, greatest] = p.radius_mm.map(figure);
    let volume: f64 = drops.droplets().iter().map(|d| Cap::new(d.radius_mm, p.contact_angle_rad).volume_mm3()).sum();
    let largest = drops.droplets().iter().map(|d| d.radius_mm).fold(0.0, f64::max);
    let there = vec![
        format!(
            "drops of water on it, traced: {} of {least} to {greatest} mm radius fell on {} × {} mm, joined to {} of at most {} mm; \
             contact angle {}°; they cover {:.2} % of it and hold {:.1} µl",
            p.count,
            figure(p.size_mm.x),
            figure(p.size_mm.y),
            count(drops.droplets().len(), "drop"),
            figure(largest),
            figure(p.contact_angle_rad.to_degrees()),
            100.0 * drops.cover(),
            volume
        ),
        "left out: reflections in part at the drops, what shines from inside through them, their wet trails, their weight's effect on \
         their shape; ground truth does not see them"
            .to_owned(),
    ];
    there.into_iter().chain(p.course.as_ref().map(course)).collect()
}

/// How they change.
fn course(course: &Course) -> String {
    let Course { start_s, sliding, drying_s, arrivals_hz, wiper } = course;
    let slide = sliding
        .map(|s| format!("slide at up to {} mm/s from {} mm radius", figure(s.speed_mm_s), figure(s.still_radius_mm)));
    let dry = drying_s.map(|s| format!("dry in {} s", figure(s)));
    let arrive = (*arrivals_hz > 0.0).then(|| format!("arrive at {} a second", figure(*arrivals_hz)));
    let wiped = wiper.map(|w| format!("are wiped every {} s from {} s", figure(w.period_s), figure(w.start_s)));
    let changes: Vec<String> = [slide, dry, arrive, wiped].into_iter().flatten().collect();
    format!(
        "drops change from {} s on, those above are of then: they {}; each exposure sees them as they are in its middle",
        figure(*start_s),
        changes.join(", ")
    )
}
