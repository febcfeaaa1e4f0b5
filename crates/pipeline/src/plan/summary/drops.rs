//! What is said of drops of water on a wind-screen.

use super::{count, figure};
use etendue_optics::front::{Cap, Drops};

/// What lies there, and what of it is left out.
pub(super) fn drops(drops: &Drops) -> Vec<String> {
    let p = drops.parameters();
    let [least, greatest] = p.radius_mm.map(figure);
    let volume: f64 = drops.droplets().iter().map(|d| Cap::new(d.radius_mm, p.contact_angle_rad).volume_mm3()).sum();
    let largest = drops.droplets().iter().map(|d| d.radius_mm).fold(0.0, f64::max);
    vec![
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
    ]
}
