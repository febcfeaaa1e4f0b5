//! Instancers.

use super::ConvertedScene;

fn instancer(more: &str, metadata: &str) -> ConvertedScene {
    ConvertedScene::new(&format!(
        "def PointInstancer \"i\" {metadata} {{ rel prototypes = </i/Ball> int[] protoIndices = [0, 0, 0] {more}\n\
         point3f[] positions = [(1,0,0), (2,0,0), (3,0,0)] def Sphere \"Ball\" {{ double radius = 1 }} }}\n"
    ))
}

/// Positions of the spheres along x.
fn places(converted: &ConvertedScene) -> Vec<f64> {
    converted.scene.objects.iter().map(|o| o.transform.position_m.as_ref().map_or(0.0, |p| p.value[0])).collect()
}

#[test]
fn inactive_and_invisible_instances_are_left_out() {
    assert_eq!(places(&instancer("", "")), [1.0, 2.0, 3.0]);
    assert_eq!(places(&instancer("int64[] invisibleIds = [0]", "( inactiveIds = [2] )")), [2.0]);
    assert_eq!(places(&instancer("int64[] ids = [7, 8, 9]", "( inactiveIds = [8, 0] )")), [1.0, 3.0]);
}

#[test]
fn an_instancer_that_is_not_drawn_is_reported() {
    let converted = instancer("token visibility = \"invisible\"", "");
    assert!(
        converted.scene.objects.is_empty() && converted.reports("prims that are invisible"),
        "{}",
        converted.report_text
    );
    assert!(!converted.reports("relationship"), "{}", converted.report_text);
}
