//! Tests of the whole list of effects.

use super::*;
use crate::report::FrameCost;
use crate::{Choices, compile};
use etendue_scene::asset::Assets;
use etendue_scene::{Description, Overrides};
use std::collections::BTreeSet;
use std::path::Path;

/// Plan of a job of one camera that looks along +x, with changes.
pub(super) fn plan_of(lens: &str, camera: &str, render: &str, set: &str) -> Plan {
    let plain = "sensor = { width_px = 120, height_px = 80, pixel_pitch_um = 6.0 }";
    let sensor = if camera.starts_with("sensor") { "" } else { plain };
    let text = format!(
        "format = 1\n[scene.environment]\ntype = \"uniform\"\nluminance_cd_m2 = 10\nilluminant = \"D65\"\n[[cameras]]\nname = \"front\"\n\
         position_m = [0, 0, 1]\nlook_at_m = [10, 0, 1]\n{lens}\n{sensor}\n\
         {camera}\n[render]\nspp = 4\n{render}\n"
    );
    let read = |_: &Path| Ok(text.clone());
    let overrides = Overrides::new((!set.is_empty()).then_some(set));
    let job = Description::load(Path::new("job.toml"), &read, &overrides).unwrap_or_else(|errors| panic!("{errors}"));
    let plan = compile(&job, &Assets::default(), &Choices::default());
    plan.unwrap_or_else(|errors| panic!("{}", errors.iter().map(|f| format!("{f}\n")).collect::<String>()))
}

const PINHOLE: &str = "lens = { type = \"pinhole\", focal_length_mm = 1, f_number = 8 }";

#[test]
fn names_are_unique_and_every_reason_is_stated() {
    let plan = plan_of(PINHOLE, "", "", "");
    let effects = plan.effects(&plan.cameras[0]);
    let ids: BTreeSet<String> = effects.iter().map(PlannedEffect::id).collect();
    assert_eq!(ids.len(), effects.len());
    let plain =
        |id: &String| !id.is_empty() && id.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_');
    assert!(ids.iter().all(plain), "{ids:?}");
    assert!(effects.iter().all(|effect| !effect.status.reason().is_empty()));
    let groups: Vec<_> = effects.iter().map(|effect| effect.group).collect();
    let order = |group: &EffectGroup| EffectGroup::ALL.iter().position(|other| other == group);
    assert!(groups.is_sorted_by_key(order), "effects stand in the order of their groups");
}

#[test]
fn what_is_skipped_takes_nothing_and_cannot_be_dropped() {
    let plan = plan_of(PINHOLE, "", "", "");
    for effect in plan.effects(&plan.cameras[0]).iter().filter(|effect| !effect.status.is_modelled()) {
        assert!(effect.cpu_s.is_none() && effect.memory_bytes.is_none() && effect.omission.is_none(), "{effect:?}");
    }
}

/// The estimated saving of dropping an effect is the difference of the frames' estimated times.
#[test]
fn savings_are_differences_of_whole_frames() {
    let effects =
        "effects = { margin = 0.1, psf = { blades = 6 }, glare = { scatter = 0.02, core_um = 25, exponent = 2.5 } }";
    let thin = "lens = { type = \"thin\", focal_length_mm = 6, f_number = 4.0, focus_distance_m = 5 }";
    let glare = "effects = { glare = { scatter = 0.02, core_um = 25, exponent = 2.5 } }";
    for (camera, render) in [
        (effects, "band_width_nm = 20\nmax_bounces = 5"),
        ("", "branches = 4\nmax_bounces = 5"),
        ("", "branches = 4\nguiding = true"),
        (glare, "band_width_nm = 20"),
        ("", "max_bounces = 2"),
    ] {
        let plan = plan_of(thin, camera, render, "");
        let whole_s = FrameCost::new(&plan, &plan.cameras[0]).cpu_s();
        let mut compared = 0;
        for effect in plan.effects(&plan.cameras[0]) {
            let Some(OmissionResult { set: Some(set), cpu_saved_s: Some(saved_s), .. }) = &effect.omission else {
                continue;
            };
            let [set] = set.as_slice() else { continue };
            let without = plan_of(thin, camera, render, set);
            let cpu_saved = whole_s - FrameCost::new(&without, &without.cameras[0]).cpu_s();
            assert!(
                (cpu_saved - saved_s).abs() < 1e-6 * whole_s,
                "{}: {saved_s} foretold, and it is {cpu_saved}",
                effect.name
            );
            compared += 1;
        }
        assert!(compared >= 2, "{compared}");
    }
}
