//! `[[textures]]`: images on surfaces.

use std::path::{Path, PathBuf};

use crate::asset::layer_key;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{choice, number, path, record, text, vector, words};

/// Extensions of image files for textures and masks.
pub(crate) const IMAGE_EXTENSIONS: &[&str] =
    &["png", "jpg", "jpeg", "tga", "bmp", "tif", "tiff", "webp", "dds", "ppm", "pgm", "hdr", "exr"];

record! {
    /// An image that materials use as reflectance, as a factor, as normals or on their emission.
    pub struct Texture check(check) {
        /// Name.
        required name: Placed<String> = text("the name of the texture");
        /// The image; its first row is at v = 1.
        required file: Placed<PathBuf> = path(IMAGE_EXTENSIONS);
        /// Layer of an EXR file, or one of its channels. Default: the channels R, G, B or Y without a layer.
        optional layer: Placed<String> = text("the name of a layer");
        /// Meaning of the file's values.
        required encoding: Placed<Encoding> = choice();
        /// Extension outside u, v = 0 … 1. Default: "repeat".
        optional wrap: Placed<Wrap> = choice();
        /// Mapping from the surface to the image. Default: "uv".
        optional mapping: Placed<Mapping> = choice();
        /// With mapping = "triplanar": image size on the surface, in the frame of the mesh's file or shape.
        optional size_m: Placed<f64> = number("m").above(0.0);
        /// With mapping = "triplanar": sharpness of the transitions. Default: 4.
        optional sharpness: Placed<f64> = number("").at_least(1.0).at_most(64.0);
        /// With mapping = "uv": repetitions along u and v. Default: 1, 1.
        optional uv_scale: Placed<[f64; 2]> = vector::<2>(number("").above(0.0));
        /// With mapping = "uv": position of u, v = 0, 0 in the image. Default: 0, 0.
        optional uv_offset: Placed<[f64; 2]> = vector::<2>(number(""));
    }
}

words! {
    /// Meaning of an image's values.
    pub enum Encoding {
        /// Colours, encoded by the curve of IEC 61966-2-1.
        "srgb" => Srgb,
        /// Colours proportional to reflectance or light, primaries of sRGB.
        "linear" => Linear,
        /// Plain values: roughness, opacity, weights, normals.
        "data" => Data,
    }
}

words! {
    /// Mapping from points of a surface to an image.
    pub enum Mapping {
        /// By the texture coordinates of the mesh.
        "uv" => Uv,
        /// By the position in the object's own frame, along its three axes, blended by the normal.
        "triplanar" => Triplanar,
    }
}

words! {
    /// Extension outside an image.
    pub enum Wrap {
        /// Repeated.
        "repeat" => Repeat,
        /// Clamped to its edge.
        "clamp" => Clamp,
        /// Mirrored.
        "mirror" => Mirror,
    }
}

impl Texture {
    /// Its image among the images of the assets.
    #[must_use]
    pub fn image_key(&self) -> PathBuf {
        image_key(&self.file.value, self.layer.as_ref())
    }

    /// Mapping from points of a surface to the image.
    #[must_use]
    pub fn mapping(&self) -> Mapping {
        self.mapping.as_ref().map_or(Mapping::Uv, |m| m.value)
    }
}

/// Key of an image, or of its layer, among the images of the assets.
pub(crate) fn image_key(file: &Path, layer: Option<&Placed<String>>) -> PathBuf {
    layer.map_or_else(|| file.to_owned(), |layer| layer_key(file, &layer.value))
}

fn check(texture: &Texture, errors: &mut DescriptionErrors) {
    if let (Mapping::Triplanar, Some(mapping), None) = (texture.mapping(), &texture.mapping, &texture.size_m) {
        let problem = "mapping = \"triplanar\" does not state the size of the image on the surface";
        errors.add(ErrorCode::MissingKey, &mapping.place, problem, "add \"size_m\"");
    }
    let of_sides = [("size_m", &texture.size_m), ("sharpness", &texture.sharpness)];
    for (key, value) in of_sides.into_iter().filter(|_| texture.mapping() == Mapping::Uv) {
        if let Some(value) = value {
            let problem = format!("\"{key}\" has no effect here, it belongs to mapping = \"triplanar\"");
            errors.add(ErrorCode::NoEffect, &value.place, problem, "remove it, or set the mapping");
        }
    }
    let of_uv = [("uv_scale", &texture.uv_scale), ("uv_offset", &texture.uv_offset)];
    for (key, value) in of_uv.into_iter().filter(|_| texture.mapping() == Mapping::Triplanar) {
        if let Some(value) = value {
            let problem = format!("\"{key}\" has no effect here, it belongs to mapping = \"uv\"");
            errors.add(ErrorCode::NoEffect, &value.place, problem, "remove it; \"size_m\" sets the size of the image");
        }
    }
}
