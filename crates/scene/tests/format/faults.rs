//! Texts of errors: each is pinned.

use std::path::Path;

use etendue_scene::{Overrides, load_camera};

use crate::files::{DescriptionFiles, load};

/// Body of a small valid job.
const JOB: &str = r#"
[[scene.materials]]
name = "grey"
type = "diffuse"
reflectance = 0.18

[[scene.objects]]
name = "wall"
shape = { type = "quad", size_m = [2, 2] }
material = "grey"
position_m = [5, 0, 1]
"#;

/// Errors of the job with `old` replaced by `new`, one per line.
pub(crate) fn errors_of_job(old: &str, new: &str) -> String {
    let mut files = DescriptionFiles::with_camera(JOB);
    files.edit("job.toml", old, new);
    load(&files, &[]).err().map_or(String::new(), |f| f.to_string())
}

/// Errors of the job under overrides.
fn errors_of_changes(sets: &[&str]) -> String {
    load(&DescriptionFiles::with_camera(JOB), sets).err().map_or(String::new(), |f| f.to_string())
}

#[test]
fn the_job_itself_is_right() {
    assert_eq!(errors_of_changes(&[]), "");
}

/// A misspelt required key is one error: it is not reported as missing as well.
#[test]
fn a_misspelt_key() {
    assert_eq!(
        errors_of_job("f_number", "f_nmuber"),
        "job.toml:11:1: cameras.front.lens.f_nmuber: unknown key \"f_nmuber\"; did you mean \"f_number\"?"
    );
}

#[test]
fn an_unknown_key_without_a_near_one() {
    let text = errors_of_job("size_m = [2, 2]", "size_m = [2, 2], banana = 1");
    assert_eq!(
        text,
        "job.toml:26:43: scene.objects.wall.shape.banana: unknown key \"banana\"; \
         remove it; the keys are \"type\", \"size_m\""
    );
}

#[test]
fn a_key_of_another_variant() {
    assert_eq!(
        errors_of_job("reflectance = 0.18", "reflectance = 0.18\nalpha = 0.1"),
        "job.toml:23:1: scene.materials.grey.alpha: \"alpha\" has no effect here, it belongs to type = \"conductor\" or \
         type = \"coated\" or type = \"cook_torrance\" or type = \"car_paint\" or type = \"cloth\" or type = \"dielectric\"; remove it"
    );
}

#[test]
fn an_unknown_variant() {
    assert_eq!(
        errors_of_job("type = \"diffuse\"", "type = \"difuse\""),
        "job.toml:21:8: scene.materials.grey.type: found the text \"difuse\"; did you mean \"diffuse\"? Give one of \"diffuse\", \"conductor\", \
         \"coated\", \"wet_ground\", \"cook_torrance\", \"lafortune\", \"blinn_phong\", \"car_paint\", \"cloth\", \"retro_sheeting\", \"road_marking\", \"dielectric\", \"thin_sheet\", \"leaf\", \"mix\", \"emitter\""
    );
}

#[test]
fn a_wrong_type() {
    assert_eq!(
        errors_of_job("width_px = 64", "width_px = \"64\""),
        "job.toml:15:12: cameras.front.sensor.width_px: found the text \"64\"; give a whole number from 1 to 65536"
    );
    assert_eq!(
        errors_of_job("position_m = [5, 0, 1]", "position_m = [5, 0]"),
        "job.toml:28:14: scene.objects.wall.position_m: found a list of 2; give a list of 3 numbers, each a finite number (m)"
    );
}

#[test]
fn a_negative_exposure() {
    let mut files = DescriptionFiles::from_example();
    files.edit("camera.toml", "exposure_s = 0.002", "exposure_s = -0.002");
    let text = load(&files, &[]).expect_err("negative").to_string();
    assert_eq!(text, "camera.toml:16:14: sensor.exposure_s: found -0.002; give a number of at least 0 (s)");
}

#[test]
fn a_picture_of_no_size() {
    assert_eq!(
        errors_of_job("height_px = 48", "height_px = 0"),
        "job.toml:16:13: cameras.front.sensor.height_px: found 0; give a whole number from 1 to 65536"
    );
}

#[test]
fn a_focal_length_of_zero() {
    assert_eq!(
        errors_of_job("focal_length_mm = 6", "focal_length_mm = 0"),
        "job.toml:10:19: cameras.front.lens.focal_length_mm: found 0; give a number above 0 (mm)"
    );
}

#[test]
fn numbers_that_are_none() {
    let text = errors_of_job("f_number = 2.0\nfocus_distance_m = 5.0", "f_number = nan\nfocus_distance_m = inf");
    assert_eq!(
        text,
        "job.toml:11:12: cameras.front.lens.f_number: found NaN; give a number of at least 0.5\n\
         job.toml:12:20: cameras.front.lens.focus_distance_m: found inf; give a number above 0 (m)"
    );
    assert!(
        errors_of_job("position_m = [5, 0, 1]", "position_m = [5, -inf, 1]")
            .contains("found -inf; give a finite number")
    );
    assert!(errors_of_job("f_number = 2.0", "f_number = 1e999").contains("number of at least 0.5"));
    assert!(
        errors_of_job("width_px = 64", "width_px = 99999999999999999999").contains("an integer too large for 64 bits")
    );
    for digitless in ["0x", "0xg1", "0b2"] {
        let messages = errors_of_changes(&[&format!("render.spp={digitless}")]);
        assert!(
            !messages.contains("too large") && messages.ends_with("give a whole number from 1 to 1048576"),
            "{messages}"
        );
    }
}

#[test]
fn an_unknown_material() {
    assert_eq!(
        errors_of_job("material = \"grey\"", "material = \"gray\""),
        "job.toml:27:12: scene.objects.wall.material: there is no material \"gray\"; did you mean \"grey\"? Known: grey"
    );
    let text = errors_of_job("material = \"grey\"", "material = \"grey\"\nclass = \"wall\"");
    assert_eq!(
        text,
        "job.toml:28:9: scene.objects.wall.class: there is no class \"wall\"; define the class; the scene has none"
    );
}

#[test]
fn a_material_that_is_faulty_is_still_known() {
    let text = errors_of_job("reflectance = 0.18", "reflectance = 1.8");
    assert_eq!(
        text,
        "job.toml:22:15: scene.materials.grey.reflectance: found 1.8; give a number of at least 0 and at most 1"
    );
}

#[test]
fn an_unknown_texture_mesh_and_metal() {
    let text = errors_of_job("reflectance = 0.18", "reflectance = { texture = \"brick\" }");
    assert!(text.contains("scene.materials.grey.reflectance.texture: there is no texture \"brick\""), "{text}");
    let text = errors_of_job("shape = { type = \"quad\", size_m = [2, 2] }", "mesh = \"car\"");
    assert!(text.contains("scene.objects.wall.mesh: there is no mesh \"car\""), "{text}");
    let text =
        errors_of_job("type = \"diffuse\"\nreflectance = 0.18", "type = \"conductor\"\nmetal = \"Pb\"\nalpha = 0.1");
    assert!(text.contains("scene.materials.grey.metal: found the text \"Pb\"; give one of \"A"), "{text}");
}

#[test]
fn duplicate_statements() {
    let twice = "position_m = [5, 0, 1]\ninstances = [{ position_m = [1, 0, 0] }]";
    assert!(errors_of_job("position_m = [5, 0, 1]", twice).contains("\"instances\" contradicts \"position_m\""));
    assert_eq!(
        errors_of_job("look_at_m = [10, 0, 1]", "look_at_m = [10, 0, 1]\nrotation_deg = [0, 0, 0]"),
        "job.toml:7:1: cameras.front.rotation_deg: \"look_at_m\", \"rotation_deg\" contradict each other; give exactly one of \
         \"look_at_m\", \"rotation_deg\""
    );
    let file = "file = \"camera.toml\"\nposition_m = [0, 0, 1]";
    let message = errors_of_job("position_m = [0, 0, 1]", file);
    assert!(message.contains("cameras.front.lens: \"lens\" contradicts \"file\""), "{message}");
}

#[test]
fn one_name_twice() {
    let twice = "[[scene.materials]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.2\n\n[[scene.objects]]";
    assert_eq!(
        errors_of_job("[[scene.objects]]", twice),
        "job.toml:25:8: scene.materials.grey.name: the name \"grey\" is already used at line 20; choose a different one"
    );
    let classes = "[scene.classes]\ncar = 26\nvan = 26\n\n[[scene.objects]]";
    let message = errors_of_job("[[scene.objects]]", classes);
    assert!(message.contains("scene.classes.van: the class number 26 is already used at line 25"), "{message}");
}

#[test]
fn a_format_that_is_missing_or_another() {
    assert_eq!(
        errors_of_job("format = 1", ""),
        "job.toml:1:1: the key \"format\" is missing; add \"format = 1\" at the start of the file"
    );
    assert_eq!(
        errors_of_job("format = 1", "format = 2"),
        "job.toml:1:10: format: found format 2; this program reads format 1; write the file in format 1, or use a \
         program that reads this format"
    );
}

#[test]
fn overrides_that_are_wrong() {
    let cases = [
        ("render.spp", "`set` render.spp: expected key=value; give a dotted key, \"=\" and a value: render.spp=16"),
        ("render.spp=0", "`set` render.spp=0: found 0; give a whole number from 1 to 1048576"),
        (
            "cameras.front.lens.f_number=-1",
            "`set` cameras.front.lens.f_number=-1: found -1; give a number of at least 0.5",
        ),
        (
            "cameras.frnt.lens.f_number=4",
            "`set` cameras.frnt.lens.f_number=4: there is no entry \"frnt\"; did you mean \"front\"? give the number \
             0, or a name: front",
        ),
        (
            "format.x=4",
            "`set` format.x=4: unknown key \"format\"; remove it; the keys are \"scene\", \"cameras\", \"sequence\", \
             \"render\", \"output\"",
        ),
        (
            "scene.objects.wall.shape.size_m.x.y=4",
            "`set` scene.objects.wall.shape.size_m.x.y=4: there is no entry \"x\"; give a number from 0 to 1",
        ),
        ("cameras.front.name.x=4", "`set` cameras.front.name.x=4: there is no table for \"x\"; correct the key"),
        (
            "cameras.front.lens.distorsion=null",
            "`set` cameras.front.lens.distorsion=null: there is no \"distorsion\" in \"cameras.front.lens\" to remove; correct \
             the key, or omit the change",
        ),
        (
            "cameras.front.lens.focal_length=null",
            "`set` cameras.front.lens.focal_length=null: there is no \"focal_length\" in \"cameras.front.lens\" to remove; did \
             you mean \"focal_length_mm\"? correct the key, or omit the change",
        ),
        (
            "scene.objects.wal=null",
            "`set` scene.objects.wal=null: there is no \"wal\" in \"scene.objects\" to remove; did you mean \
             \"wall\"? correct the key, or omit the change",
        ),
    ];
    for (set, expected) in cases {
        assert_eq!(errors_of_changes(&[set]), expected);
    }
    assert!(
        errors_of_changes(&["render.ssp=16"])
            .starts_with("`set` render.ssp=16: unknown key \"ssp\"; did you mean \"spp\"?")
    );
}

#[test]
fn what_is_taken_out_is_as_if_it_had_not_been_written() {
    let read = |sets: &[&str]| load(&DescriptionFiles::with_camera(JOB), sets).expect("a job");
    let objects = read(&[]).scene.objects.len();
    assert_eq!(read(&["scene.objects.wall=null"]).scene.objects.len(), objects - 1);
    assert!(read(&["render.spp=16"]).cameras[0].render.samples.spp.is_some());
    assert!(read(&["render.spp=16", "render.spp=null"]).cameras[0].render.samples.spp.is_none(), "the last one wins");
    assert_eq!(
        errors_of_changes(&["cameras.front.lens.f_number=null"]),
        "job.toml:8:1: cameras.front.lens: the key \"f_number\" is missing; add it: a number of at least 0.5"
    );
}

#[test]
fn a_margin_without_its_route() {
    assert_eq!(
        errors_of_changes(&["cameras.front.render={overscan=0.1}"]),
        "`set` cameras.front.render={overscan=0.1}: \"overscan\" has no effect here, it belongs to route = \"pupil\"; remove it"
    );
    assert_eq!(errors_of_changes(&["cameras.front.render={overscan=0.1}", "render.route=pupil"]), "");
}

/// Notices of the job with `render` added under overrides.
fn notices(render: &str, change: impl Fn(&mut Overrides)) -> Result<Vec<String>, String> {
    let files = DescriptionFiles::with_camera(&format!("{JOB}\n[render]\n{render}\n"));
    let mut overrides = Overrides::default();
    change(&mut overrides);
    let description = etendue_scene::Description::load(Path::new("job.toml"), &|p| files.read(p), &overrides);
    description.map(|d| d.overridden_keys).map_err(|f| f.to_string())
}

#[test]
fn the_command_line_supersedes_what_it_makes_meaningless() {
    let message = notices("max_bounces = 8\ncaustics = false", |o| o.add("render.integrator=direct"));
    let expected = "`set` render.integrator=direct overrides \"max_bounces\" (job.toml:31), \"caustics\" (job.toml:32)";
    assert_eq!(message, Ok(vec![expected.to_owned()]));
    let message = notices("max_bounces = 8", |o| o.add_render("`integrator` flat", "integrator", "\"flat\""));
    assert_eq!(message, Ok(vec!["`integrator` flat overrides \"max_bounces\" (job.toml:31)".to_owned()]));
    let message = notices("route = \"pupil\"\noverscan = 0.1", |o| o.add("render.route=lens"));
    assert_eq!(message, Ok(vec!["`set` render.route=lens overrides \"overscan\" (job.toml:32)".to_owned()]));
    let message = notices("", |o| o.add("cameras.front.lens.type=pinhole"));
    let expected = "`set` cameras.front.lens.type=pinhole overrides \"focus_distance_m\" (job.toml:12)";
    assert_eq!(message, Ok(vec![expected.to_owned()]));
    let message = notices("integrator = \"direct\"\nmax_bounces = 8", |_| {}).expect_err("the file contradicts itself");
    assert!(message.starts_with("job.toml:32:15: render.max_bounces: \"max_bounces\" has no effect here"), "{message}");
    let both =
        |o: &mut Overrides| ["render.integrator=direct", "render.max_bounces=8"].iter().for_each(|set| o.add(set));
    let message = notices("", both).expect_err("the command line contradicts itself");
    assert!(message.starts_with("`set` render.max_bounces=8: \"max_bounces\" has no effect here"), "{message}");
}

#[test]
fn a_flag_goes_through_the_check_of_its_key() {
    let spp = |n: &'static str| notices("spp = 8", move |o| o.add_render(&format!("`spp` {n}"), "spp", n));
    assert_eq!(spp("16"), Ok(Vec::new()));
    for n in ["0", "1048577", "2147483648"] {
        assert_eq!(spp(n), Err(format!("`spp` {n}: found {n}; give a whole number from 1 to 1048576")));
    }
    let seed = notices("", |o| o.add_render("`seed` 18446744073709551615", "seed", "18446744073709551615"));
    let message = seed.expect_err("larger than a key can hold");
    assert!(message.starts_with("`seed` 18446744073709551615: found an integer too large for 64 bits"), "{message}");
}

#[test]
fn files_that_cannot_be_read() {
    let mut files = DescriptionFiles::from_example();
    files.edit("job.toml", "scene = \"scene.toml\"", "scene = \"scenes.toml\"");
    files.edit("job.toml", "seed = 1", "sede = 1");
    let text = load(&files, &[]).expect_err("no scene").to_string();
    assert_eq!(text.lines().count(), 2, "both faults are told, nothing is said of what could not be read:\n{text}");
    assert!(text.starts_with(
        "job.toml:2:9: scene: cannot read \"scenes.toml\": no such file; correct the path, which is relative to the file \
         that names it"
    ));
}

#[test]
fn a_file_of_another_kind_is_one_fault() {
    let example = DescriptionFiles::from_example();
    let as_job = |kind: &str| {
        let mut files = DescriptionFiles::from_example();
        files.put("job.toml", &example.text(kind));
        load(&files, &[]).expect_err("no job").to_string()
    };
    assert_eq!(as_job("scene.toml"), "job.toml:1:1: this is a scene file; give a job file that refers to it");
    assert_eq!(as_job("camera.toml"), "job.toml:1:1: this is a camera file; give a job file that refers to it");
    let set = |set: &str| load(&example, &[set]).expect_err("another kind").to_string();
    assert_eq!(
        set("scene=camera.toml"),
        "`set` scene=camera.toml: \"camera.toml\" is a camera file; give a scene file"
    );
    assert_eq!(
        set("cameras.front.file=scene.toml"),
        "`set` cameras.front.file=scene.toml: \"scene.toml\" is a scene file; give a camera file"
    );
    assert_eq!(
        set("cameras.front.file=job.toml"),
        "`set` cameras.front.file=job.toml: this is a job file; give a camera file"
    );
    let camera = load_camera(Path::new("job.toml"), &|p| example.read(p), &Overrides::default());
    assert_eq!(camera.expect_err("a job").to_string(), "job.toml:1:1: this is a job file; give a camera file");
}

#[test]
fn brackets_too_many_or_too_few() {
    assert_eq!(
        errors_of_job("[[scene.materials]]", "[scene.materials]").lines().next(),
        Some("job.toml:19:1: scene.materials: found one table; give a list of tables: use double brackets, [[ ]]")
    );
    assert_eq!(
        errors_of_job("[cameras.lens]", "[[cameras.lens]]"),
        "job.toml:8:1: cameras.front.lens: found a list of tables; give one table: use single brackets, [ ]"
    );
}

#[test]
fn text_that_is_not_toml() {
    let text = errors_of_job("f_number = 2.0", "f_number = = 2.0");
    assert!(text.starts_with("job.toml:11:12: invalid TOML: "), "{text}");
    let text = errors_of_job("f_number = 2.0", "f_number = 2.0\nf_number = 2.0");
    assert!(text.contains("job.toml:12:1: invalid TOML: duplicate key"), "{text}");
    // A missing quotation mark invalidates every later line: only the first place is reported.
    let text = errors_of_job("format = 1", "format = { a = \"");
    assert!(text.starts_with("job.toml:1:") && text.lines().count() <= 3, "{text}");
}

#[test]
fn several_faults_at_once() {
    let mut files = DescriptionFiles::from_example();
    files.edit("job.toml", "spp = 64", "spp = -64");
    files.edit("camera.toml", "bits = 12", "bits = 33");
    files.edit("camera.toml", "fill_factor", "fil_factor");
    files.edit("scene.toml", "class = \"road\"", "class = \"raod\"");
    files.edit("scene.toml", "illuminance_lx", "illuminance_lux");
    files.edit("scene.toml", "size_m = [100.0, 8.0]", "size_m = [100.0, -8.0]");
    let errors = load(&files, &[]).expect_err("seven faults");
    let places: Vec<_> =
        errors.as_slice().iter().map(|f| (f.place.file().to_str().expect("a name"), f.place.key())).collect();
    let expected = [
        ("camera.toml", "sensor.fil_factor"),
        ("camera.toml", "sensor.bits"),
        ("job.toml", "render.spp"),
        ("scene.toml", "objects.road.shape.size_m[1]"),
        ("scene.toml", "objects.road.class"),
        ("scene.toml", "lights.sun"),
        ("scene.toml", "lights.sun.illuminance_lux"),
    ];
    assert_eq!(places, expected.map(|(file, key)| (file, key.into())), "{errors}");
}

#[test]
fn light_that_says_too_little_or_too_much() {
    let emitter = |emission: &str| {
        errors_of_job("type = \"diffuse\"\nreflectance = 0.18", &format!("type = \"emitter\"\n{emission}"))
    };
    assert!(emitter("").contains("scene.materials.grey: an \"emitter\" without \"emission\" is black"));
    assert!(emitter("emission = { luminance_cd_m2 = 1 }").contains("does not state the colour of the light"));
    assert!(emitter("emission = { radiance_w_m2_sr_nm = 1, temperature_k = 3000 }").contains("contradicts it"));
    assert!(emitter("emission = { luminance_cd_m2 = 1, rgb = [0, 0, 0] }").contains("no chromaticity"));
    assert_eq!(emitter("emission = { radiance_w_m2_sr_nm = 1, sides = \"both\" }"), "");
}

#[test]
fn sensors_that_contradict_themselves() {
    let errors = |old: &str, new: &str| {
        let mut files = DescriptionFiles::from_example();
        files.edit("camera.toml", old, new);
        load(&files, &[]).err().map_or(String::new(), |f| f.to_string())
    };
    assert!(errors("cfa = \"rggb\"", "cfa = \"mono\"").contains("three channels contradicts cfa = \"mono\""));
    assert!(errors("black_level_dn = 168", "black_level_dn = 4095").contains("an ADC of 12 bits ends at 4095 DN"));
    assert!(
        errors("{ camera = \"canon-eos-5d-mark-ii\", peak = 0.5 }", "[0.3, 0.4, { spectrum = \"blue.csv\" }]")
            .is_empty()
    );
    assert!(errors(", peak = 0.5", "").contains("need \"peak\""));
    assert!(errors("exposure_s = 0.002\n", "").contains("sensor: the key \"exposure_s\" is missing"));
}

#[test]
fn cameras_that_look_nowhere() {
    let text = errors_of_job("look_at_m = [10, 0, 1]", "look_at_m = [0, 0, 5]");
    assert!(text.contains("cameras.front.look_at_m: the camera looks at its own position or along \"up\""), "{text}");
    assert_eq!(errors_of_job("look_at_m = [10, 0, 1]", "look_at_m = [0, 0, 5]\nup = [1, 0, 0]"), "");
}

#[test]
fn one_camera_at_least() {
    let files = DescriptionFiles::from_job("format = 1\ncameras = []\nscene = {}\n");
    let text = load(&files, &[]).expect_err("no camera").to_string();
    assert!(text.starts_with("job.toml:2:11: cameras: found a list of 0; give a list of 1 or more"), "{text}");
}
