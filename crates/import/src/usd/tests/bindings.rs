//! Materials of prims.

use super::{CARD, ConvertedScene, surface};

fn plain(names: &[&str]) -> String {
    names.iter().map(|name| surface(name, "")).collect()
}

#[test]
fn strong_bindings_and_those_for_full_rendering_go_before_near_ones() {
    let converted = ConvertedScene::new(&format!(
        "{}def Xform \"strong\" {{ rel material:binding = </Outer> ( bindMaterialAs = \"strongerThanDescendants\" )\n\
           def Mesh \"a\" {{ {CARD} rel material:binding = </Inner> }} }}\n\
         def Xform \"weak\" {{ rel material:binding = </Outer>\n\
           def Mesh \"b\" {{ {CARD} rel material:binding = </Inner> }} }}\n\
         def Xform \"full\" {{ rel material:binding:full = </Full>\n\
           def Mesh \"c\" {{ {CARD} rel material:binding = </Inner> }} }}\n\
         def Mesh \"d\" {{ {CARD} rel material:binding:preview = </Inner> }}\n",
        plain(&["Outer", "Inner", "Full"])
    ));
    let names = ["a", "b", "c"].map(|name| converted.material_name(name));
    assert_eq!(names, ["Outer", "Inner", "Full"]);
    assert!(converted.material_name("d").starts_with("default"), "{}", converted.material_name("d"));
    assert!(
        converted.reports("Mesh: the relationship \"material:binding:preview\" is not used"),
        "{}",
        converted.report_text
    );
}

/// A subset whose mesh has a material for full rendering takes that one, as its own is for all purposes.
#[test]
fn subsets_inherit_by_purpose() {
    let converted = ConvertedScene::new(&format!(
        "{}def Mesh \"a\" {{ {CARD} rel material:binding:full = </Full>\n\
           def GeomSubset \"s\" {{ int[] indices = [1] rel material:binding = </Inner> }} }}\n\
         def Mesh \"b\" {{ {CARD} rel material:binding = </Outer>\n\
           def GeomSubset \"s\" {{ int[] indices = [1] rel material:binding = </Inner> }} }}\n",
        plain(&["Outer", "Inner", "Full"])
    ));
    assert_eq!(["a", "a-2", "b", "b-2"].map(|name| converted.material_name(name)), ["Full", "Full", "Outer", "Inner"]);
}

#[test]
fn collections_and_other_relationships_are_reported() {
    let converted = ConvertedScene::new(&format!(
        "{}def Mesh \"a\" {{ {CARD} rel material:binding:collection:red = [</a.collection:red>, </Outer>]\n\
         rel collection:red:includes = </a> rel proxyPrim = </a> rel skel:skeleton = </a> }}\n",
        plain(&["Outer"])
    ));
    assert!(converted.reports("material bindings of collections are not used"), "{}", converted.report_text);
    assert!(
        converted.reports("Mesh: the relationship \"skel:skeleton\" is not used (/a)"),
        "{}",
        converted.report_text
    );
    assert_eq!(converted.report_text.matches("relationship").count(), 1, "{}", converted.report_text);
}
