//! Pictures of plain numbers (roughness, opacity), of pictures that hold them as encoded colours.

use super::stage::Scenery;
use etendue_io::Provenance;
use etendue_io::exr::{Layer, encode_layers};
use etendue_scene::asset::{ImageAsset, ImagePixels};
use etendue_spectra::colour::decode;

/// Red, green, blue and opacity of each pixel as they are stored, 1 for the greatest number of whole ones.
pub(crate) fn stored_pixels(image: &ImageAsset) -> Vec<[f32; 4]> {
    let byte = |b: u8| f32::from(b) / 255.0;
    let grey = |g: f32| [g, g, g, 1.0];
    match &image.pixels {
        ImagePixels::Gray8(p) => p.iter().map(|g| grey(byte(*g))).collect(),
        ImagePixels::Gray16(p) => p.iter().map(|g| grey(f32::from(*g) / 65_535.0)).collect(),
        ImagePixels::Rgb8(p) => p.iter().map(|p| p.map(byte)).map(|[r, g, b]| [r, g, b, 1.0]).collect(),
        ImagePixels::Rgba8(p) => p.iter().map(|p| p.map(byte)).collect(),
        ImagePixels::Rgb32F(p) => p.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect(),
        ImagePixels::Rgba32F(p) => p.clone(),
    }
}

impl Scenery {
    /// Writes the numbers of a picture of sRGB-encoded colours: what `number` makes of linear red, green and blue; the path of the file, which holds them
    /// as greys.
    pub(crate) fn numbers_file(
        &mut self,
        image: &ImageAsset,
        wish: &str,
        number: fn([f32; 3]) -> f32,
    ) -> Result<String, String> {
        let of = |[r, g, b, _]: [f32; 4]| number([r, g, b].map(decode));
        let numbers: Vec<f32> = stored_pixels(image).into_iter().map(of).collect();
        let layers = ["B", "G", "R"].map(|name| (name.to_owned(), Layer::Float(&numbers)));
        let (width, height) = (image.width as usize, image.height as usize);
        let bytes = encode_layers(width, height, &layers, &Provenance::default()).map_err(|e| e.to_string())?;
        let own = self.file_names.take(wish, "numbers");
        let path = self.add_file(format!("textures/{own}.exr"), bytes);
        self.check_size()?;
        Ok(path)
    }
}
