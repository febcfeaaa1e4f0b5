//! Drops of water on a wind-screen.

use super::super::context::Context;
use etendue_core::ExactTime;
use etendue_optics::PRINCIPAL_NM;
use etendue_optics::front::{Course, Curve, DropsParameters, Sliding, Wiper};
use etendue_scene::record::front::drops::{self as record, DropAmount};
use etendue_spectra::dielectric;
use glam::DVec2;

/// Of drops that condense and join: see the record.
const SIZE_EXPONENT: f64 = 8.0 / 3.0;
const CONTACT_ANGLE_DEG: f64 = 60.0;

pub(super) fn drops(r: &record::Drops, context: &mut Context<'_>) -> DropsParameters {
    let contact_angle_deg = r.contact_angle_deg.as_ref().map_or(CONTACT_ANGLE_DEG, |a| a.value);
    DropsParameters {
        offset_mm: r.offset_mm.as_ref().map_or(DVec2::ZERO, |o| DVec2::from_array(o.value)),
        size_mm: DVec2::from_array(r.size_mm.value),
        count: count(r),
        radius_mm: [r.min_radius_mm.value, r.max_radius_mm.value],
        size_exponent: r.size_exponent.as_ref().map_or(SIZE_EXPONENT, |e| e.value),
        contact_angle_rad: contact_angle_deg.to_radians(),
        index: water(r.dispersion.as_ref().is_none_or(|d| d.value)),
        seed: r.seed.as_ref().map_or(0, |s| s.value),
        course: r.changes().then(|| course(r, context)),
    }
}

fn course(r: &record::Drops, context: &mut Context<'_>) -> Course {
    let zero_s = context.epoch.to(ExactTime::default());
    let start_s = r.start_s.as_ref().map_or(zero_s, |start| context.since_epoch_s(start));
    let sliding =
        |s: &record::Sliding| Sliding { speed_mm_s: s.speed_mm_s.value, still_radius_mm: s.still_radius_mm.value };
    let wiper = |w: &record::Wiper| Wiper {
        pivot_mm: DVec2::from_array(w.pivot_mm.value),
        blade_mm: w.blade_mm.value,
        angles_rad: w.angles_deg.value.map(f64::to_radians),
        sweep_s: w.sweep_s.value,
        period_s: w.period_s.value,
        start_s: w.start_s.as_ref().map_or(start_s, |start| context.since_epoch_s(start)),
    };
    Course {
        start_s,
        sliding: r.sliding.as_ref().map(sliding),
        drying_s: r.drying_s.as_ref().map(|s| s.value),
        arrivals_hz: r.arrivals_per_s.as_ref().map_or(0.0, |s| s.value),
        wiper: r.wiper.as_ref().map(wiper),
    }
}

/// Of the drops that fell: the record has checked that they are 1 to 1 000 000.
fn count(r: &record::Drops) -> u32 {
    match &r.amount {
        DropAmount::Count(count) => count.value as u32,
        DropAmount::Density(density) => {
            let [width, height] = r.size_mm.value;
            ((density.value * width * height * 1e-4).round() as u32).max(1)
        }
    }
}

fn water(disperses: bool) -> Curve {
    let index = &dielectric::named("water").expect("water is among the dielectrics").n;
    match disperses {
        true => Curve::Table(Box::new(index.clone())),
        false => Curve::Constant(f64::from(index.at(PRINCIPAL_NM as f32))),
    }
}
