//! Descriptions that could crash a program: long lines, deep keys.

use crate::files::{DescriptionFiles, load};

const JOB: &str = r#"
[[scene.materials]]
name = "grey"
type = "diffuse"
reflectance = 0.18

[scene]
"#;

/// Objects of a list on one line.
fn objects(count: usize) -> String {
    let object = |i: usize| {
        format!("{{name=\"o{i}\",shape={{type=\"quad\",size_m=[1,1]}},material=\"grey\",position_m=[5,0,{i}]}}")
    };
    (0..count).map(object).collect::<Vec<_>>().join(",")
}

/// With columns counted from the start of the line, this number took minutes.
#[test]
fn a_hundred_thousand_objects_on_one_line() {
    let files = DescriptionFiles::with_camera(&format!("{JOB}objects=[{}]\n", objects(100_000)));
    let description = load(&files, &[]).expect("a right job");
    assert_eq!(description.scene.objects.len(), 100_000);
    let mut files = files;
    files.edit("job.toml", "[5,0,99999]", "[5,0,\"x\"]");
    let column = files.text("job.toml").lines().last().expect("the list").find("\"x\"").expect("the fault") + 1;
    let message = load(&files, &[]).expect_err("a text for a number").to_string();
    assert!(message.starts_with(&format!("job.toml:25:{column}: scene.objects.o99999.position_m")), "{message}");
}

#[test]
fn a_base_of_many_objects_under_as_many() {
    let list = objects(30_000);
    let mut files = DescriptionFiles::with_camera("");
    files.edit("job.toml", "format = 1\n", "format = 1\nscene = \"over.toml\"\n");
    let materials = "materials=[{name=\"grey\",type=\"diffuse\",reflectance=0.18}]";
    files.put("over.toml", &format!("format=1\nbase=\"under.toml\"\nobjects=[{list}]\n"));
    files.put("under.toml", &format!("format=1\n{materials}\nobjects=[{list}]\n"));
    assert_eq!(load(&files, &[]).expect("a right job").scene.objects.len(), 30_000);
}

/// One nested table per part overflowed the stack.
#[test]
fn a_key_of_twenty_thousand_parts() {
    let set = format!("{}=1", vec!["a"; 20_000].join("."));
    let message =
        load(&DescriptionFiles::with_camera(&format!("{JOB}objects=[]\n")), &[&set]).expect_err("too deep").to_string();
    assert!(message.starts_with("`set` a.a.a.a."), "{message}");
    let end = "…: this key has 20000 parts; at most 80 are possible; correct the key: render.spp=16";
    assert!(message.ends_with(end) && message.len() < 400, "{message}");
}
