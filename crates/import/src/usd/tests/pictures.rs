//! UsdUVTexture.

use super::{ConvertedScene, surface};
use etendue_scene::record::Reflectance;
use etendue_scene::record::Texture;
use etendue_scene::record::material::{Factor, Surface};
use etendue_scene::record::texture::{Encoding, Wrap};

/// Card whose texture coordinates reach `end`, with an image as its colour.
fn card(end: f64, file: &str, inputs: &str) -> ConvertedScene {
    card_of(end, file, inputs, "color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>")
}

fn card_of(end: f64, file: &str, inputs: &str, used: &str) -> ConvertedScene {
    let material = surface("M", used).trim_end().trim_end_matches('}').to_owned();
    let mesh = super::CARD;
    ConvertedScene::new(&format!(
        "{material} def Shader \"T\" {{ uniform token info:id = \"UsdUVTexture\" asset inputs:file = @{file}@ {inputs} float3 outputs:rgb float outputs:r }} }}\n\
         def Mesh \"a\" {{ {mesh} rel material:binding = </M>\n\
         texCoord2f[] primvars:st = [(0, 0), ({end}, 0), ({end}, {end}), (0, {end})] ( interpolation = \"vertex\" ) }}\n"
    ))
}

fn texture(converted: &ConvertedScene) -> &Texture {
    let [texture] = &converted.scene.textures[..] else {
        panic!("{} textures: {}", converted.scene.textures.len(), converted.report_text)
    };
    texture
}

fn wrap(converted: &ConvertedScene) -> Wrap {
    texture(converted).wrap.as_ref().expect("said").value
}

const OUTSIDE: &str = "is clamped to its edge outside u, v = 0 … 1";

#[test]
fn an_image_without_a_wrap_mode_is_black_outside() {
    for inputs in ["", "token inputs:wrapS = \"useMetadata\" token inputs:wrapT = \"black\""] {
        let within = card(1.0, "letter.png", inputs);
        assert_eq!(wrap(&within), Wrap::Clamp);
        assert!(
            !within.reports(OUTSIDE) && !within.reports("wrapS and wrapT of an image differ"),
            "{}",
            within.report_text
        );
        let beyond = card(2.0, "letter.png", inputs);
        assert_eq!(wrap(&beyond), Wrap::Clamp);
        assert!(beyond.reports(OUTSIDE) && beyond.reports("which the shape shows (/a)"), "{}", beyond.report_text);
    }
    let again = card(2.0, "letter.png", "token inputs:wrapS = \"repeat\" token inputs:wrapT = \"repeat\"");
    assert_eq!(wrap(&again), Wrap::Repeat);
    assert!(!again.reports(OUTSIDE), "{}", again.report_text);
}

#[test]
fn the_file_says_whether_its_colours_are_encoded() {
    let encoding = |file: &str, inputs: &str| texture(&card(1.0, file, inputs)).encoding.value;
    for auto in ["", "token inputs:sourceColorSpace = \"auto\""] {
        assert_eq!(encoding("letter.png", auto), Encoding::Srgb);
        assert_eq!(encoding("grey.png", auto), Encoding::Linear);
        assert_eq!(encoding("grey16.png", auto), Encoding::Linear);
    }
    assert_eq!(encoding("letter.png", "token inputs:sourceColorSpace = \"raw\""), Encoding::Linear);
    assert_eq!(encoding("grey.png", "token inputs:sourceColorSpace = \"sRGB\""), Encoding::Srgb);
}

/// Roughness from the red channel of an 8-bit colour image is decoded; from a grey image it is not.
#[test]
fn numbers_of_encoded_pictures_are_decoded() {
    let alphas = |file: &str, inputs: &str| {
        let converted = card_of(1.0, file, inputs, "float inputs:roughness.connect = </M/T.outputs:r>");
        let Surface::CoatedDiffuse(coated) = &converted.material("a").surface.0 else {
            panic!("{}", converted.report_text)
        };
        let Factor::Texture(_) = &coated.alpha else { panic!("{}", converted.report_text) };
        let (name, bytes) = converted.files.iter().find(|(name, _)| name.ends_with(".exr")).expect("numbers");
        let image = etendue_io::picture::decode_image(std::path::Path::new(name), bytes).expect("a picture");
        crate::scenery::stored_pixels(&image).iter().map(|pixel| f64::from(pixel[0])).collect::<Vec<_>>()
    };
    // 128 of 255, squared.
    let grey = alphas("grey.png", "");
    assert!((grey[1] - 128.0 * 128.0 / (255.0 * 255.0)).abs() < 1e-6, "{grey:?}");
    assert_ne!(alphas("letter.png", ""), alphas("letter.png", "token inputs:sourceColorSpace = \"raw\""));
    assert_eq!(alphas("letter.png", ""), alphas("letter.png", "token inputs:sourceColorSpace = \"sRGB\""));
}

/// The same image, three times as bright: as a reflectance it is clamped to 1, as light it is not.
#[test]
fn colours_by_different_rules_are_different_pictures() {
    let used = "color3f inputs:diffuseColor.connect = </M/T.outputs:rgb> color3f inputs:emissiveColor.connect = </M/T.outputs:rgb>";
    let converted = card_of(1.0, "letter.png", "float4 inputs:scale = (3, 3, 3, 1)", used);
    let [a, b] = &converted.scene.textures[..] else { panic!("{}", converted.scene.textures.len()) };
    let Surface::CoatedDiffuse(coated) = &converted.material("a").surface.0 else {
        panic!("{}", converted.report_text)
    };
    let Reflectance::Texture { name: reflectance, .. } = &coated.reflectance else {
        panic!("{}", converted.report_text)
    };
    let light = converted.material("a").emission.as_ref().and_then(|light| light.texture.as_ref()).expect("a texture");
    let mut named = [&reflectance.value, &light.value];
    named.sort();
    let mut all = [&a.name.value, &b.name.value];
    all.sort();
    assert_eq!(named, all);
    let largest = |texture: &str| {
        let texture = converted.scene.textures.iter().find(|t| t.name.value == texture).expect("a texture");
        let name = texture.file.value.to_string_lossy().into_owned();
        let (_, bytes) = converted.files.iter().find(|(file, _)| *file == name).expect("a file");
        let image = etendue_io::picture::decode_image(std::path::Path::new(&name), bytes).expect("a picture");
        crate::scenery::stored_pixels(&image).iter().fold(0.0_f32, |most, pixel| most.max(pixel[0]))
    };
    assert!(largest(&reflectance.value) <= 1.0 && largest(&light.value) > 1.5);
}
