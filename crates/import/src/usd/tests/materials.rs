//! UsdPreviewSurface.

use super::{ConvertedScene, surface};
use etendue_scene::record::material::{Factor, Surface};

fn ball(inputs: &str) -> ConvertedScene {
    ConvertedScene::new(&format!("{}def Sphere \"a\" {{ rel material:binding = </M> }}\n", surface("M", inputs)))
}

/// Opacity of a surface, if it is constant.
fn opacity(converted: &ConvertedScene) -> Option<f64> {
    match &converted.material("a").opacity {
        Some(Factor::Number(number)) => Some(number.value),
        _ => None,
    }
}

#[test]
fn opacity_that_is_presence_makes_no_glass() {
    let presence = ball("float inputs:opacity = 0.3 token inputs:opacityMode = \"presence\"");
    assert!(matches!(presence.material("a").surface.0, Surface::CoatedDiffuse(_)), "{}", presence.report_text);
    assert_eq!(opacity(&presence), Some(0.3));
    assert!(!presence.reports("opacity"), "as it is meant: {}", presence.report_text);
    for mode in ["", "token inputs:opacityMode = \"transparent\""] {
        let glass = ball(&format!("float inputs:opacity = 0.3 {mode}"));
        assert!(matches!(glass.material("a").surface.0, Surface::ThinSheet(_)), "{mode}");
        assert!(!glass.reports("opacityMode"), "{}", glass.report_text);
        let thin = ball(&format!("float inputs:opacity = 0.7 {mode}"));
        assert_eq!(opacity(&thin), Some(0.7));
        assert!(
            thin.reports("opacity is the fraction of the surface that is present, including its specular reflection"),
            "{mode}"
        );
    }
}

#[test]
fn an_index_beyond_those_of_coats_is_the_nearest() {
    for (stated, expected) in [("0.8", 1.1), ("1.05", 1.1), ("5", 4.0), ("1.5", 1.5)] {
        let converted = ball(&format!("float inputs:ior = {stated}"));
        let Surface::CoatedDiffuse(coated) = &converted.material("a").surface.0 else {
            panic!("{stated}: {}", converted.report_text)
        };
        assert_eq!(coated.index.as_ref().map(|index| index.value), Some(expected));
        let message = format!("the refractive index {stated} of \"ior\" is limited to {expected}: expected 1.1 … 4");
        assert_eq!(converted.reports(&message), expected.to_string() != stated, "{}", converted.report_text);
    }
    let sheet = ball("float inputs:opacity = 0.1 float inputs:ior = 5");
    assert!(
        sheet.reports("the refractive index 5 of \"ior\" is limited to 4: expected 1 … 4"),
        "{}",
        sheet.report_text
    );
    // An index of 1 reflects nothing.
    let converted = ball("float inputs:ior = 1");
    assert!(
        matches!(converted.material("a").surface.0, Surface::Diffuse(_)) && !converted.reports("refractive"),
        "{}",
        converted.report_text
    );
}
