//! Files merged over a base.

use etendue_scene::record::{Environment, Lens};

use crate::files::{DescriptionFiles, load};

/// The page's example; its scene and camera are bases of files that state only `scene` and `camera`.
fn derived_example(scene: &str, camera: &str) -> DescriptionFiles {
    let mut files = DescriptionFiles::from_example();
    files.rename("scene.toml", "base/scene.toml");
    files.rename("camera.toml", "base/camera.toml");
    files.put("scene.toml", &format!("format = 1\nbase = \"base/scene.toml\"\n{scene}"));
    files.put("camera.toml", &format!("format = 1\nbase = \"base/camera.toml\"\n{camera}"));
    files
}

fn base_errors(scene: &str, camera: &str) -> String {
    load(&derived_example(scene, camera), &[]).expect_err("a fault").to_string()
}

#[test]
fn a_base_alone_is_the_base() {
    let (plain, merged) = (load(&DescriptionFiles::from_example(), &[]), load(&derived_example("", ""), &[]));
    let (plain, merged) = (plain.expect("the example"), merged.expect("over the example"));
    assert_eq!(plain.scene.objects.len(), merged.scene.objects.len());
    assert_eq!(plain.cameras[0].camera.sensor.width_px, merged.cameras[0].camera.sensor.width_px);
    // Paths are relative to the file that names them.
    let paths = |d: &etendue_scene::Description| d.assets().iter().map(|a| a.path.clone()).collect::<Vec<_>>();
    let moved: Vec<_> = paths(&plain).iter().map(|p| std::path::Path::new("base").join(p)).collect();
    assert_eq!(paths(&merged), moved);
}

#[test]
fn tables_are_merged_and_forms_replaced() {
    let uniform = "[environment]\ntype = \"uniform\"\nradiance_w_m2_sr_nm = 0.1\n";
    let camera = "[sensor]\nexposure_s = 0.25\n[lens]\ntype = \"pinhole\"\nfocal_length_mm = 3\nf_number = 8\n";
    let description = load(&derived_example(uniform, camera), &[]).expect("laid over");
    assert!(matches!(description.scene.environment, Some(Environment::Uniform(_))));
    let camera = &description.cameras[0].camera;
    assert!(matches!(camera.lens, Lens::Pinhole(_)));
    assert_eq!(camera.sensor.electronics.as_ref().expect("electronics").exposure_s, 0.25);
    assert_eq!(camera.sensor.width_px, 640);
}

#[test]
fn entries_are_replaced_by_name_added_and_taken_out() {
    let base = load(&DescriptionFiles::from_example(), &[]).expect("the example");
    let names = |d: &etendue_scene::Description| -> Vec<String> {
        d.scene.materials.iter().map(|m| m.name.value.clone()).collect()
    };
    let first = names(&base)[0].clone();
    let scene = format!(
        "remove = [\"lights.sun\"]\n[[materials]]\nname = \"{first}\"\ntype = \"diffuse\"\nreflectance = 0.125\n\
         [[materials]]\nname = \"new\"\ntype = \"diffuse\"\nreflectance = 0.5\n"
    );
    let merged = load(&derived_example(&scene, ""), &[]).expect("laid over");
    assert_eq!(names(&merged), [names(&base), vec!["new".to_owned()]].concat());
    assert_eq!(merged.scene.lights.len(), base.scene.lights.len() - 1);
    assert!(merged.scene.lights.iter().all(|light| light.name().value != "sun"));
}

#[test]
fn faults_name_the_file_that_says_it() {
    assert_eq!(
        base_errors("", "[sensor]\nexposure_s = -1\n"),
        "camera.toml:4:14: sensor.exposure_s: found -1; give a number of at least 0 (s)"
    );
    assert_eq!(
        base_errors("remove = [\"lights.son\"]\n", ""),
        "scene.toml:3:11: remove[0]: found the text \"lights.son\", but the base has no such entry; give dotted keys of the base: \
         \"environment\", \"lights.sun\""
    );
    assert!(base_errors("remove = 3\n", "").contains("remove: found 3; give a list of dotted keys"));
    let mut files = derived_example("", "");
    files.edit("base/scene.toml", "format = 1", "format = 1\nbase = \"../scene.toml\"");
    // In memory, paths are not normalised: "base/../scene.toml" is no file here, as a missing base.
    assert!(load(&files, &[]).expect_err("a fault").to_string().contains("cannot read \"base/../scene.toml\""));
    let mut files = derived_example("", "");
    files.edit("scene.toml", "base/scene.toml", "scene.toml");
    assert_eq!(
        load(&files, &[]).expect_err("a fault").to_string(),
        "scene.toml:2:8: base: \"scene.toml\" is its own base; give another base, or none"
    );
    let mut files = DescriptionFiles::from_example();
    files.edit("scene.toml", "format = 1", "format = 1\nremove = []");
    assert!(load(&files, &[]).expect_err("a fault").to_string().contains("\"remove\" has no effect without \"base\""));
}

/// A job over the page's.
fn derived_job(job: &str) -> DescriptionFiles {
    let mut files = DescriptionFiles::from_example();
    files.rename("job.toml", "base.toml");
    files.put("job.toml", &format!("format = 1\nbase = \"base.toml\"\n{job}"));
    files
}

#[test]
fn a_job_states_differences_and_its_cameras_are_merged_by_name() {
    let base = load(&DescriptionFiles::from_example(), &[]).expect("the example");
    let job = "[render]\nseed = 9\n[[cameras]]\nname = \"front\"\nrender = { spp = 8 }\n";
    let merged = load(&derived_job(job), &[]).expect("laid over");
    let spp = |d: &etendue_scene::Description, i: usize| d.cameras[i].render.samples.spp.as_ref().map(|spp| spp.value);
    assert_eq!((spp(&base, 0), spp(&merged, 0)), (Some(256), Some(8)));
    assert_eq!(spp(&merged, 1), spp(&base, 1), "the other camera is as it was");
    assert!(merged.cameras.iter().all(|c| c.render.seed.as_ref().is_some_and(|seed| seed.value == 9)));
    assert_eq!(merged.cameras[0].camera.sensor.width_px, base.cameras[0].camera.sensor.width_px);
    let fewer = load(&derived_job("remove = [\"cameras.left\"]\n"), &[]).expect("taken out");
    assert_eq!((base.cameras.len(), fewer.cameras.len()), (2, 1));
    let error = load(&derived_job("[[cameras]]\nname = \"front\"\nrender = { spp = 0 }\n"), &[]);
    assert!(error.expect_err("a fault").to_string().starts_with("job.toml:5:"), "the file that says it");
}
