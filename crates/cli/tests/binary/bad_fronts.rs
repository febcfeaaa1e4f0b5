//! Invalid mirrors and glass in front of the lens: refused with file, line and key.

use crate::support::{CommandOutput, etendue, text};
use std::fs;

const CAMERA: &str = "format = 1\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 6\nf_number = 4\n[sensor]\nwidth_px = 8\n\
                      height_px = 6\npixel_pitch_um = 100\n";
const JOB: &str = "format = 1\nscene = {}\n[[cameras]]\nname = \"c\"\nfile = \"camera.toml\"\nposition_m = [0, 0, 1]\n\
                   look_at_m = [9, 0, 1]\n";

/// Plans a job whose camera has this in front of its lens; `[front…]` is line 10 of its file.
fn plan(front: &str, job: &str) -> CommandOutput {
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(place.path().join("camera.toml"), format!("{CAMERA}{front}\n")).expect("written");
    fs::write(place.path().join("job.toml"), format!("{JOB}{job}\n")).expect("written");
    etendue(["plan", &text(&place.path().join("job.toml"))])
}

const SPHERE: &str =
    "[external_optics.mirror]\ntype = \"sphere\"\nradius_mm = 30\nrim_radius_mm = 25\nreflectance = 0.9\n";
const GLASS: &str = "[external_optics.windscreen]\ndistance_mm = 100\n";

#[test]
fn mirrors_that_the_camera_cannot_look_at() {
    plan(&format!("{SPHERE}distance_mm = 50"), "").ok();
    plan(SPHERE, "").refused(&["camera.toml:10", "external_optics.mirror", "distance_mm"]);
    let turned = format!("{SPHERE}distance_mm = 50\nrotation_deg = [180, 0, 0]");
    plan(&turned, "").refused(&["camera.toml:10", "external_optics.mirror", "seen from inside"]);
    let aside = format!("{SPHERE}distance_mm = 50\noffset_mm = [900, 0]");
    plan(&aside, "").refused(&["camera.toml:10", "external_optics.mirror", "no pixel"]);
    let wide = SPHERE.replace("rim_radius_mm = 25", "rim_radius_mm = 31\ndistance_mm = 50");
    plan(&wide, "").refused(&["camera.toml:10", "reaches only 30"]);
    let hole = format!("{SPHERE}distance_mm = 50\nhole_radius_mm = 25");
    plan(&hole, "").refused(&["hole_radius_mm = 25", "rim_radius_mm = 25"]);
}

#[test]
fn glass_that_the_camera_cannot_look_through() {
    plan(GLASS, "").ok();
    plan(&GLASS.replace("100", "0"), "").refused(&["camera.toml:11", "external_optics.windscreen.distance_mm"]);
    plan(&format!("{GLASS}tilt_deg = 90"), "").refused(&["camera.toml:12", "external_optics.windscreen.tilt_deg"]);
    let wedge = format!("{GLASS}tilt_deg = 60\nwedge_mrad = 100");
    plan(&wedge, "").refused(&["camera.toml:10", "external_optics.windscreen", "faces cross", "wedge_mrad"]);
    plan(&format!("{GLASS}reference_thickness_mm = 4"), "").refused(&["camera.toml:12", "no effect"]);
    plan(&format!("{GLASS}double_image = false\ndouble_image_sample_fraction = 0.5"), "").refused(&["no effect"]);
    plan(&format!("{GLASS}internal_transmittance = 0"), "").refused(&["camera.toml:10", "internal_transmittance"]);
    plan("[external_optics]", "").refused(&["camera.toml:10", "there is nothing in front"]);
    let both = format!("{GLASS}{SPHERE}distance_mm = 50");
    let dirt = "[external_optics.dirt]\nmask = \"m.png\"\nsize_mm = [90, 90]\ndistance_mm = 101\n";
    plan(&format!("{GLASS}{dirt}"), "").refused(&[
        "camera.toml:15",
        "external_optics.dirt.distance_mm",
        "beyond the windscreen;",
    ]);
    plan(dirt, "").refused(&["camera.toml:11", "m.png"]);
    plan(&both, "").refused(&["camera.toml:12", "not modelled", "keep one"]);
}

#[test]
fn what_bends_rays_has_no_route_at_the_pupil() {
    let route = "[render]\nroute = \"pupil\"";
    plan(GLASS, route).refused(&["job.toml:9", "render.route", "windscreen", "route = \"lens\""]);
    plan(&format!("{SPHERE}distance_mm = 50"), route).refused(&["job.toml:9", "mirror", "route = \"lens\""]);
    let tinted = format!("{GLASS}internal_transmittance = [0.7, 0.9, 0.8]");
    plan(&tinted, "[render]\nwavelengths_per_path = 4").refused(&["job.toml:9", "dispersive optics"]);
    plan(&format!("{GLASS}internal_transmittance = 0.7"), "[render]\nwavelengths_per_path = 4").ok();
}

const DROPS: &str = "[external_optics.windscreen]\ndistance_mm = 100\n[external_optics.windscreen.drops]\nsize_mm = [90, 60]\n\
                     min_radius_mm = 0.5\nmax_radius_mm = 2\n";

#[test]
fn drops_that_cannot_lie_on_the_glass() {
    let assert_refused = |more: &str, phrases: &[&str]| plan(&format!("{DROPS}{more}"), "").refused(phrases);
    let fine = plan(&format!("{DROPS}count = 40"), "").ok().out;
    assert!(fine.contains("water drops on the windscreen") && fine.contains("40 of 0.5 to 2 mm radius"), "{fine}");
    plan(&format!("{DROPS}count_per_dm2 = 100"), "").ok();
    assert_refused("", &["camera.toml:12", "external_optics.windscreen.drops", "count"]);
    assert_refused("count = 0", &["camera.toml:16", "drops.count", "none are added"]);
    assert_refused("count = 4\ncount_per_dm2 = 4", &["camera.toml:1", "count_per_dm2"]);
    assert_refused("count_per_dm2 = 0.1", &["camera.toml:16", "count_per_dm2", "0.054 drops"]);
    assert_refused("count = 4\ncontact_angle_deg = 4", &["camera.toml:17", "contact_angle_deg"]);
    assert_refused("count = 4\ncontact_angle_deg = 151", &["camera.toml:17", "contact_angle_deg"]);
    assert_refused("count = 4\nsize_exponent = -1", &["camera.toml:17", "size_exponent"]);
    assert_refused("count = 4\noffset_mm = [900, 0]", &["camera.toml:12", "no pixel", "offset_mm"]);
    let swapped = format!("{DROPS}count = 4").replace("max_radius_mm = 2", "max_radius_mm = 0.4");
    plan(&swapped, "").refused(&["camera.toml:14", "min_radius_mm", "above max_radius_mm = 0.4"]);
    // One wavelength per path, except where the index is that of one wavelength.
    let four = "[render]\nwavelengths_per_path = 4";
    plan(&format!("{DROPS}count = 4"), four).refused(&["job.toml:9", "dispersive optics"]);
    plan(&format!("{DROPS}count = 4\ndispersion = false"), four).ok();
    let curved =
        DROPS.replace("distance_mm = 100", "distance_mm = 100\nradius_across_mm = 95").replace("[90, 60]", "[300, 60]");
    plan(&format!("{curved}count = 40"), "").refused(&["camera.toml:13", "no surface", "size_mm"]);
}

#[test]
fn drops_that_cannot_change_as_described() {
    let assert_refused = |more: &str, phrases: &[&str]| plan(&format!("{DROPS}count = 4\n{more}"), "").refused(phrases);
    plan(&format!("{DROPS}count = 0\narrivals_per_s = 3"), "").ok();
    assert_refused("start_s = 1", &["camera.toml:17", "drops.start_s", "no effect"]);
    assert_refused("drying_s = 0", &["camera.toml:17", "drops.drying_s"]);
    assert_refused("arrivals_per_s = -1", &["camera.toml:17", "drops.arrivals_per_s"]);
    let sliding = "[external_optics.windscreen.drops.sliding]\nspeed_mm_s = 50\n";
    plan(&format!("{DROPS}count = 4\n{sliding}still_radius_mm = 1"), "").ok();
    assert_refused(
        &format!("{sliding}still_radius_mm = 2"),
        &["camera.toml:19", "still_radius_mm", "not below max_radius_mm = 2"],
    );
    assert_refused(sliding, &["camera.toml:17", "still_radius_mm"]);
    let wiper = "[external_optics.windscreen.drops.wiper]\npivot_mm = [0, 300]\nblade_mm = [50, 300]\nangles_deg = [-80, 20]\nsweep_s = 0.5\n\
                 period_s = 1\n";
    plan(&format!("{DROPS}count = 4\n{wiper}"), "").ok();
    assert_refused(&wiper.replace("= 1\n", "= 0.9\n"), &["camera.toml:22", "wiper.period_s", "there and back, 1 s"]);
    assert_refused(
        &wiper.replace("[50, 300]", "[300, 50]"),
        &["camera.toml:19", "wiper.blade_mm", "smaller distance first"],
    );
    assert_refused(&wiper.replace("[-80, 20]", "[20, 20]"), &["camera.toml:20", "wiper.angles_deg", "differ"]);
    assert_refused(&wiper.replace("0.5", "0.05"), &["camera.toml:21", "wiper.sweep_s"]);
}

/// The command line can set keys of the camera's file.
#[test]
fn what_stands_in_front_and_the_effects_can_be_set() {
    let place = tempfile::tempdir().expect("a temporary folder");
    fs::write(
        place.path().join("camera.toml"),
        format!("{CAMERA}{GLASS}[effects.glare]\nscatter = 0.01\ncore_um = 20\nexponent = 3\n"),
    )
    .expect("written");
    fs::write(place.path().join("job.toml"), JOB).expect("written");
    let job = text(&place.path().join("job.toml"));
    let set =
        ["--set", "cameras.c.external_optics.windscreen.tilt_deg=30", "--set", "cameras.c.effects.glare.scatter=0.02"];
    let output = etendue(["plan", job.as_str()].into_iter().chain(set)).ok().out;
    assert!(output.contains("30.0° from the axis") && output.contains("0.02 of the light"), "{output}");
}
