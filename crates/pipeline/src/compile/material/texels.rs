//! Pixels of images as the tracer stores them.

use etendue_scene::asset::{ColourMatrix, ImagePixels, PixelFormat};
use etendue_spectra::colour;
use etendue_tracer::textures::{TexelEncoding, Texels};

/// Interpretation of an image as texels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct TexelInterpretation {
    /// The numbers are encoded with the curve of sRGB.
    pub(super) encoded: bool,
    /// The opacity is read instead of the colours.
    pub(super) alpha: bool,
    /// The numbers are colours, not data.
    pub(super) colour: bool,
    /// A factor on the numbers.
    pub(super) scale: f32,
}

impl TexelInterpretation {
    /// Encoding of [`TexelInterpretation::texels`] for pixels of a format.
    pub(super) fn encoding(self, format: PixelFormat) -> TexelEncoding {
        match (format.is_bytes() && self.scale == 1.0, self.encoded && !self.alpha) {
            (true, true) => TexelEncoding::Srgb8,
            (true, false) => TexelEncoding::Linear8,
            (false, _) => TexelEncoding::Float,
        }
    }

    /// Converts pixels to texels, colours with the matrix to Rec. 709; `None` if opacity is read and there is none.
    pub(super) fn texels(self, pixels: &ImagePixels, to_rec_709: Option<ColourMatrix>) -> Option<Texels> {
        let to_rec_709 = to_rec_709.filter(|_| self.colour);
        if self.alpha { opacity(pixels, self.scale) } else { Some(colours(pixels, self, to_rec_709)) }
    }
}

/// The colours; a factor other than 1 requires linear numbers.
fn colours(
    pixels: &ImagePixels,
    TexelInterpretation { encoded, scale, .. }: TexelInterpretation,
    to_rec_709: Option<ColourMatrix>,
) -> Texels {
    let bytes = |pixels: Vec<[u8; 3]>| match (encoded, scale == 1.0) {
        (true, true) => Texels::Srgb8(pixels),
        (false, true) => Texels::Linear8(pixels),
        (true, false) => floats(&pixels, |b| colour::decode_byte(b) * scale),
        (false, false) => floats(&pixels, |b| f32::from(b) / 255.0 * scale),
    };
    let linear = |v: f32| if encoded { colour::decode(v) } else { v };
    let scaled = |p: [f32; 3]| {
        let linear = p.map(linear);
        to_rec_709.map_or(linear, |matrix| matrix.apply(linear)).map(|v| v * scale)
    };
    match pixels {
        ImagePixels::Gray8(pixels) => bytes(pixels.iter().map(|g| [*g; 3]).collect()),
        ImagePixels::Gray16(pixels) => {
            Texels::Float(pixels.iter().map(|g| scaled([f32::from(*g) / 65_535.0; 3])).collect())
        }
        ImagePixels::Rgb8(pixels) => bytes(pixels.clone()),
        ImagePixels::Rgba8(pixels) => bytes(pixels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect()),
        ImagePixels::Rgb32F(pixels) => Texels::Float(pixels.iter().map(|p| scaled(*p)).collect()),
        ImagePixels::Rgba32F(pixels) => Texels::Float(pixels.iter().map(|[r, g, b, _]| scaled([*r, *g, *b])).collect()),
    }
}

/// Opacity as grey; `None` without opacity. Opacity is linear in every file.
fn opacity(pixels: &ImagePixels, scale: f32) -> Option<Texels> {
    match pixels {
        ImagePixels::Rgba8(pixels) => {
            let bytes: Vec<_> = pixels.iter().map(|[_, _, _, a]| [*a; 3]).collect();
            Some(if scale == 1.0 { Texels::Linear8(bytes) } else { floats(&bytes, |b| f32::from(b) / 255.0 * scale) })
        }
        ImagePixels::Rgba32F(pixels) => {
            Some(Texels::Float(pixels.iter().map(|[_, _, _, a]| [*a * scale; 3]).collect()))
        }
        ImagePixels::Gray8(_) | ImagePixels::Gray16(_) | ImagePixels::Rgb8(_) | ImagePixels::Rgb32F(_) => None,
    }
}

fn floats(pixels: &[[u8; 3]], linear: impl Fn(u8) -> f32) -> Texels {
    Texels::Float(pixels.iter().map(|p| p.map(&linear)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_become_those_of_rec_709_and_data_stay() {
        let swap = ColourMatrix([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 2.0]]);
        let texels = |colour: bool| {
            let reading = TexelInterpretation { encoded: false, alpha: false, colour, scale: 1.0 };
            match reading.texels(&ImagePixels::Rgb32F(vec![[0.25, 0.5, 1.0]]), Some(swap)) {
                Some(Texels::Float(texels)) => texels,
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(texels(true), [[0.5, 0.25, 2.0]]);
        assert_eq!(texels(false), [[0.25, 0.5, 1.0]]);
    }

    #[test]
    fn the_planned_encoding_is_that_of_the_texels() {
        let images = [
            (PixelFormat::Gray8, ImagePixels::Gray8(vec![7])),
            (PixelFormat::Gray16, ImagePixels::Gray16(vec![7])),
            (PixelFormat::Rgb8, ImagePixels::Rgb8(vec![[7; 3]])),
            (PixelFormat::Rgba8, ImagePixels::Rgba8(vec![[7; 4]])),
            (PixelFormat::Rgb32F, ImagePixels::Rgb32F(vec![[7.0; 3]])),
            (PixelFormat::Rgba32F, ImagePixels::Rgba32F(vec![[7.0; 4]])),
        ];
        for (format, pixels) in images {
            for (encoded, alpha, scale) in
                [(true, false, 1.0), (false, false, 1.0), (true, true, 1.0), (true, false, 2.0)]
            {
                let reading = TexelInterpretation { encoded, alpha, colour: true, scale };
                let actual = reading.texels(&pixels, None).map(|texels| match texels {
                    Texels::Srgb8(_) => TexelEncoding::Srgb8,
                    Texels::Linear8(_) => TexelEncoding::Linear8,
                    Texels::Float(_) => TexelEncoding::Float,
                });
                let expected = (!alpha || format.has_opacity()).then(|| reading.encoding(format));
                assert_eq!(actual, expected, "{format:?} {reading:?}");
            }
        }
    }
}
