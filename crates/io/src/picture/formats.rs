//! Formats of images: the list of those that are read, and their recognition.

use std::borrow::Cow;

use image::ImageFormat;

use super::radiance::is_radiance;

/// Formats of one use, and their names for messages.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RasterFormats {
    formats: &'static [ImageFormat],
    pub(crate) words: &'static str,
}

/// Textures, masks and environments, besides OpenEXR.
pub(crate) const TEXTURES: RasterFormats = RasterFormats {
    formats: &[
        ImageFormat::Png,
        ImageFormat::Jpeg,
        ImageFormat::Tga,
        ImageFormat::Bmp,
        ImageFormat::Tiff,
        ImageFormat::WebP,
        ImageFormat::Dds,
        ImageFormat::Pnm,
        ImageFormat::Hdr,
    ],
    words: "PNG, JPEG, TGA, BMP, TIFF, WebP, DDS, PNM, Radiance HDR or OpenEXR",
};

impl RasterFormats {
    /// Images to be measured; `words` names all their formats.
    pub(crate) const fn measured(words: &'static str) -> Self {
        Self { formats: &[ImageFormat::Png, ImageFormat::Jpeg, ImageFormat::Hdr], words }
    }

    /// Format of a file by its first bytes; `None` for others.
    pub(super) fn recognise(&self, bytes: &[u8]) -> Option<ImageFormat> {
        let by_magic = if is_radiance(bytes) { Some(ImageFormat::Hdr) } else { image::guess_format(bytes).ok() };
        let format = by_magic.or_else(|| TgaHead::parse(bytes).map(|_| ImageFormat::Tga));
        format.filter(|format| self.formats.contains(format))
    }
}

/// Sentence on a file of a format that is known and not read; `None` for others.
pub(super) fn unread_format(bytes: &[u8]) -> Option<&'static str> {
    const KTX2: &[u8] = b"\xabKTX 20\xbb\r\n\x1a\n";
    if bytes.starts_with(KTX2) {
        return Some(
            "a KTX2 image (Basis Universal), which is not supported; convert it to PNG, for example with `ktx extract`",
        );
    }
    match image::guess_format(bytes).ok()? {
        ImageFormat::Gif => Some("a GIF image, which is not supported; convert it to PNG"),
        ImageFormat::Avif => Some("an AVIF image, which is not supported; convert it to PNG"),
        ImageFormat::Ico => Some("an icon (ICO), which is not supported; convert it to PNG"),
        ImageFormat::Qoi => Some("a QOI image, which is not supported; convert it to PNG"),
        _ => None,
    }
}

/// Fields of a TGA header (Truevision TGA File Format Specification 2.0, 1991) that identify it.
struct TgaHead {
    image_type: u8,
    /// Bits per pixel, or per index.
    depth: u8,
    entry_bits: u8,
    descriptor: u8,
}

impl TgaHead {
    /// `None` unless all fields are legal: the format has no signature at its beginning.
    fn parse(bytes: &[u8]) -> Option<Self> {
        let [
            _,
            map_type,
            image_type,
            _,
            _,
            map_low,
            map_high,
            entry_bits,
            _,
            _,
            _,
            _,
            width_low,
            width_high,
            height_low,
            height_high,
            depth,
            descriptor,
        ] = *bytes.first_chunk::<18>()?;
        let is_mapped = matches!(image_type, 1 | 9);
        let is_legal_depth = match image_type {
            1 | 9 => {
                matches!(depth, 8 | 16) && matches!(entry_bits, 15 | 16 | 24 | 32) && [map_low, map_high] != [0; 2]
            }
            2 | 10 => matches!(depth, 15 | 16 | 24 | 32),
            3 | 11 => matches!(depth, 8 | 16),
            _ => false,
        };
        let is_legal_map = if is_mapped { map_type == 1 } else { map_type <= 1 };
        let has_size = [width_low, width_high] != [0; 2] && [height_low, height_high] != [0; 2];
        (is_legal_depth && is_legal_map && has_size && descriptor & 0xc0 == 0).then_some(Self {
            image_type,
            depth,
            entry_bits,
            descriptor,
        })
    }

    /// Bits of opacity that agree with the depth; some writers state others.
    fn attribute_bits(&self) -> u8 {
        let bits = if matches!(self.image_type, 1 | 9) { self.entry_bits } else { self.depth };
        let stated = self.descriptor & 0x0f;
        match (self.image_type, bits) {
            (_, 32) if matches!(stated, 0 | 8) => stated,
            (_, 32) => 8,
            (3 | 11, 16) => 8,
            (1 | 2 | 9 | 10, 16) => stated.min(1),
            _ => 0,
        }
    }
}

/// A TGA file whose header states the bits of opacity that its depth has.
pub(super) fn consistent_tga(bytes: &[u8]) -> Cow<'_, [u8]> {
    const DESCRIPTOR: usize = 17;
    match TgaHead::parse(bytes) {
        Some(head) if head.attribute_bits() != head.descriptor & 0x0f => {
            let mut bytes = bytes.to_vec();
            bytes[DESCRIPTOR] = head.descriptor & 0xf0 | head.attribute_bits();
            Cow::Owned(bytes)
        }
        _ => Cow::Borrowed(bytes),
    }
}
