//! Inspection of TIFF and DNG files.

use std::path::Path;

use super::{FileReport, Preview, report::ChannelReport};
use crate::Error;
use crate::photograph::{Encoding, Photograph, decode_photograph};

pub(super) fn report(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    let photograph = decode_photograph(file, bytes)?;
    let negative = file.extension().is_some_and(|name| name.eq_ignore_ascii_case("dng"));
    let mut report = FileReport::new(file, if negative { "raw, DNG" } else { "image, TIFF" });
    report.state("size", format!("{} x {} pixels", photograph.width, photograph.height));
    for channel in &photograph.channels {
        let values = channel.samples.iter().map(|v| f64::from(*v));
        report.channels.push(ChannelReport::new(&channel.name, stored_as(&photograph), values));
    }
    report.preview = Some(preview(&photograph));
    Ok(report)
}

fn stored_as(photograph: &Photograph) -> &'static str {
    match photograph.full_scale {
        None => "float",
        Some(full) if full <= 255.0 => "8 bit",
        Some(full) if full <= 65_535.0 => "16 bit",
        Some(_) => "32 bit",
    }
}

/// Preview: encoded numbers unchanged; linear ones are exposed.
fn preview(photograph: &Photograph) -> Preview {
    let (width, height) = (photograph.width, photograph.height);
    let channel = |name: &str| photograph.channel(name).map(|c| &c.samples[..]);
    let rgb: Vec<[f32; 3]> = match (channel("R"), channel("G"), channel("B")) {
        (Some(r), Some(g), Some(b)) => r.iter().zip(g).zip(b).map(|((r, g), b)| [*r, *g, *b]).collect(),
        _ => photograph.channels[0].samples.iter().map(|v| [*v; 3]).collect(),
    };
    match (&photograph.stated.encoding, photograph.full_scale) {
        (encoding, Some(full)) if *encoding != Encoding::Linear => {
            let byte = |v: f32| (f64::from(v) * 255.0 / full).round() as u8;
            Preview { width, height, rgb: rgb.iter().map(|p| p.map(byte)).collect() }
        }
        _ => Preview::from_linear(width, height, &rgb),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::tiff::encoder::{TiffEncoder, colortype};
    use std::io::Cursor;

    fn grey16(values: &[u16]) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        let mut encoder = TiffEncoder::new(&mut bytes).expect("a buffer");
        encoder.write_image::<colortype::Gray16>(values.len() as u32, 1, values).expect("a picture");
        bytes.into_inner()
    }

    #[test]
    fn numbers_are_reported_as_stored_and_scaled_for_the_preview() {
        let bytes = grey16(&[100, 100, 300, 300]);
        let actual = report(Path::new("raw.0000.tif"), &bytes).expect("grey");
        assert_eq!((actual.kind.as_str(), actual.channels[0].stored_as.as_str()), ("image, TIFF", "16 bit"));
        assert_eq!((actual.channels[0].min, actual.channels[0].mean), (Some(100.0), Some(200.0)));
        // A third of the brightest, 1/3 encoded after IEC 61966-2-1.
        let preview = actual.preview.expect("a picture");
        assert_eq!((preview.rgb[0], preview.rgb[3]), ([156; 3], [255; 3]));
        assert_eq!(report(Path::new("raw.0000.DNG"), &bytes).expect("grey").kind, "raw, DNG");
    }
}
