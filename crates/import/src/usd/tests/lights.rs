//! Lights of UsdLux.

use super::{CARD, ConvertedScene, near, surface};
use etendue_scene::record::Light;
use etendue_scene::record::light::LampStrength;
use std::f64::consts::PI;

/// Intensity of a point or spot light, cd.
fn candela(converted: &ConvertedScene, name: &str) -> f64 {
    let light_strength = converted.scene.lights.iter().find_map(|light| match light {
        Light::Point(point) if point.name.value == name => Some(&point.strength),
        Light::Spot(spot) if spot.name.value == name => Some(&spot.strength),
        _ => None,
    });
    match &light_strength.unwrap_or_else(|| panic!("no {name}: {}", converted.report_text)) {
        LampStrength::Intensity(cd) => cd.value,
        other => panic!("{other:?}"),
    }
}

/// L = I/(4 π r²) unit⁻² for a sphere of luminance L, which gives L π r² unit² from afar: I/4 unit², whatever r is.
#[test]
fn a_normalised_sphere_without_a_radius_is_a_point() {
    let converted = ConvertedScene::in_units(
        "def SphereLight \"none\" { float inputs:radius = 0 float inputs:intensity = 600 float inputs:exposure = 1 bool inputs:normalize = 1 }\n\
         def SphereLight \"small\" { float inputs:radius = 0.5 float inputs:intensity = 600 bool inputs:normalize = 1 bool treatAsPoint = 1 }\n\
         def SphereLight \"plain\" { float inputs:radius = 0.5 float inputs:intensity = 600 bool treatAsPoint = 1 }\n\
         def SphereLight \"cone\" ( apiSchemas = [\"ShapingAPI\"] ) { float inputs:radius = 0 float inputs:intensity = 600 bool inputs:normalize = 1 float inputs:shaping:cone:angle = 30 }\n\
         def SphereLight \"dark\" { float inputs:radius = 0 float inputs:intensity = 600 }\n",
        0.01,
    );
    near(candela(&converted, "none"), 300.0 * 1e-4);
    near(candela(&converted, "small"), 150.0 * 1e-4);
    near(candela(&converted, "plain"), 600.0 * PI * 0.25 * 1e-4);
    near(candela(&converted, "cone"), 150.0 * 1e-4);
    assert_eq!(converted.scene.lights.len(), 4);
    assert!(converted.reports("without \"normalize\" emits no light and is left out"), "{}", converted.report_text);
}

/// A mesh of 1 by 2 that is twice as large in the world has 8 units², whatever the materials of its faces.
#[test]
fn a_mesh_light_is_normalised_by_all_of_its_faces() {
    let light = |name: &str, more: &str| {
        format!(
            "def Mesh \"{name}\" ( apiSchemas = [\"MeshLightAPI\"] ) {{ {CARD} float inputs:intensity = 40 {more}\n\
             float3 xformOp:scale = (2, 2, 2) uniform token[] xformOpOrder = [\"xformOp:scale\"]\n\
             def GeomSubset \"s\" {{ int[] indices = [1] rel material:binding = </Red> }} }}\n"
        )
    };
    let red = surface("Red", "color3f inputs:diffuseColor = (1, 0, 0)");
    let converted =
        ConvertedScene::in_units(&[red, light("plain", ""), light("even", "bool inputs:normalize = 1")].concat(), 0.1);
    for (object, luminance) in [("plain", 40.0), ("plain-2", 40.0), ("even", 5.0), ("even-2", 5.0)] {
        near(converted.luminance(object), luminance);
    }
    assert!(
        converted.reports("mesh light: 40 cd/m², in addition to the emission of its material (2 times"),
        "{}",
        converted.report_text
    );
}
