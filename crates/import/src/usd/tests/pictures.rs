//! UsdUVTexture.

use super::{Made, surface};
use etendue_scene::record::Reflectance;
use etendue_scene::record::Texture;
use etendue_scene::record::material::{Factor, Surface};
use etendue_scene::record::texture::{Encoding, Wrap};

/// Card whose texture coordinates reach `end`, with an image as its colour.
fn card(end: f64, file: &str, inputs: &str) -> Made {
    card_of(end, file, inputs, "color3f inputs:diffuseColor.connect = </M/T.outputs:rgb>")
}

fn card_of(end: f64, file: &str, inputs: &str, used: &str) -> Made {
    let material = surface("M", used).trim_end().trim_end_matches('}').to_owned();
    let mesh = super::CARD;
    Made::of(&format!(
        "{material} def Shader \"T\" {{ uniform token info:id = \"UsdUVTexture\" asset inputs:file = @{file}@ {inputs} float3 outputs:rgb float outputs:r }} }}\n\
         def Mesh \"a\" {{ {mesh} rel material:binding = </M>\n\
         texCoord2f[] primvars:st = [(0, 0), ({end}, 0), ({end}, {end}), (0, {end})] ( interpolation = \"vertex\" ) }}\n"
    ))
}

fn texture(made: &Made) -> &Texture {
    let [texture] = &made.scene.textures[..] else { panic!("{} textures: {}", made.scene.textures.len(), made.told) };
    texture
}

fn wrap(made: &Made) -> Wrap {
    texture(made).wrap.as_ref().expect("said").value
}

const OUTSIDE: &str = "a picture that is black outside of u, v = 0 … 1";

#[test]
fn a_picture_of_which_nothing_is_said_is_black_outside() {
    for inputs in ["", "token inputs:wrapS = \"useMetadata\" token inputs:wrapT = \"black\""] {
        let within = card(1.0, "letter.png", inputs);
        assert_eq!(wrap(&within), Wrap::Clamp);
        assert!(!within.says(OUTSIDE) && !within.says("two ways"), "{}", within.told);
        let beyond = card(2.0, "letter.png", inputs);
        assert_eq!(wrap(&beyond), Wrap::Clamp);
        assert!(beyond.says(OUTSIDE) && beyond.says("has its edge there (/a)"), "{}", beyond.told);
    }
    let again = card(2.0, "letter.png", "token inputs:wrapS = \"repeat\" token inputs:wrapT = \"repeat\"");
    assert_eq!(wrap(&again), Wrap::Repeat);
    assert!(!again.says(OUTSIDE), "{}", again.told);
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
        let made = card_of(1.0, file, inputs, "float inputs:roughness.connect = </M/T.outputs:r>");
        let Surface::Coated(coated) = &made.material("a").surface.0 else { panic!("{}", made.told) };
        let Factor::Texture(_) = &coated.alpha else { panic!("{}", made.told) };
        let (name, bytes) = made.files.iter().find(|(name, _)| name.ends_with(".exr")).expect("numbers");
        let image = etendue_io::picture::decode_picture(std::path::Path::new(name), bytes).expect("a picture");
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
    let made = card_of(1.0, "letter.png", "float4 inputs:scale = (3, 3, 3, 1)", used);
    let [a, b] = &made.scene.textures[..] else { panic!("{}", made.scene.textures.len()) };
    let Surface::Coated(coated) = &made.material("a").surface.0 else { panic!("{}", made.told) };
    let Reflectance::Texture { name: reflectance, .. } = &coated.reflectance else { panic!("{}", made.told) };
    let light = made.material("a").emission.as_ref().and_then(|light| light.texture.as_ref()).expect("a texture");
    let mut named = [&reflectance.value, &light.value];
    named.sort();
    let mut all = [&a.name.value, &b.name.value];
    all.sort();
    assert_eq!(named, all);
    let most = |texture: &str| {
        let texture = made.scene.textures.iter().find(|t| t.name.value == texture).expect("a texture");
        let name = texture.file.value.to_string_lossy().into_owned();
        let (_, bytes) = made.files.iter().find(|(file, _)| *file == name).expect("a file");
        let image = etendue_io::picture::decode_picture(std::path::Path::new(&name), bytes).expect("a picture");
        crate::scenery::stored_pixels(&image).iter().fold(0.0_f32, |most, pixel| most.max(pixel[0]))
    };
    assert!(most(&reflectance.value) <= 1.0 && most(&light.value) > 1.5);
}
