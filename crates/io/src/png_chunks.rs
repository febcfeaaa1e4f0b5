//! What the chunks of a PNG say of how its numbers are encoded (PNG specification, third edition, 4.3 and 11.3.2).

use crate::encoding::{Encoding, Stated};

/// A power, in units of 1/100 000 of light^power.
const UNIT: f64 = 100_000.0;

/// Signature of a PNG.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// What a PNG says, and the names of what it says and is not understood.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Said {
    pub stated: Option<Stated>,
    pub not_understood: Option<String>,
}

/// What a chunk's data say; the name of what is not understood.
type Reader = fn(&[u8]) -> Result<Stated, String>;

/// The chunk of highest precedence that is understood; of files that are no PNG nothing.
pub(crate) fn said(file: &[u8]) -> Said {
    let chunks = chunks(file);
    let data = |name: &[u8; 4]| chunks.iter().find(|(found, _)| found == name).map(|(_, data)| *data);
    let readers: [(&[u8; 4], Reader); 4] =
        [(b"cICP", of_cicp), (b"iCCP", of_profile), (b"sRGB", |_| Ok(of_srgb())), (b"gAMA", of_gamma)];
    let mut said = Said::default();
    for (name, reader) in readers {
        match data(name).map(reader) {
            None => {}
            Some(Ok(stated)) => return Said { stated: Some(stated), ..said },
            Some(Err(name)) => said.not_understood = said.not_understood.or(Some(name)),
        }
    }
    said
}

/// The text under the keyword Title, where a PNG has one before its picture.
pub(crate) fn title(file: &[u8]) -> Option<&str> {
    let texts = chunks(file).into_iter().filter(|(name, _)| name == b"tEXt");
    let titles = texts.filter_map(|(_, data)| data.strip_prefix(b"Title\0"));
    titles.filter_map(|text| std::str::from_utf8(text).ok()).next()
}

/// The EXIF data, where a PNG has them before its picture.
pub(crate) fn exif(file: &[u8]) -> Option<&[u8]> {
    chunks(file).into_iter().find(|(name, _)| name == b"eXIf").map(|(_, data)| data)
}

/// Names and data of the chunks before the picture's own.
fn chunks(file: &[u8]) -> Vec<([u8; 4], &[u8])> {
    let mut found = Vec::new();
    let Some(mut rest) = file.strip_prefix(SIGNATURE) else { return found };
    while let Some((head, after)) = rest.split_first_chunk::<8>() {
        let length = u32::from_be_bytes([head[0], head[1], head[2], head[3]]) as usize;
        let name = [head[4], head[5], head[6], head[7]];
        let Some(data) = after.get(..length).filter(|_| &name != b"IDAT") else { break };
        found.push((name, data));
        rest = after.get(length + 4..).unwrap_or_default();
    }
    found
}

/// Coding-independent code points (ITU-T H.273, table 3): transfer characteristics that are written for pictures.
fn of_cicp(data: &[u8]) -> Result<Stated, String> {
    if data.get(3) == Some(&0) {
        return Err("its cICP chunk of narrow range".to_owned());
    }
    let (encoding, name) = match data.get(1) {
        Some(1 | 6 | 14 | 15) => (Encoding::bt709(), "BT.709"),
        Some(4) => (Encoding::Gamma(2.2), "gamma 2.2"),
        Some(5) => (Encoding::Gamma(2.8), "gamma 2.8"),
        Some(8) => (Encoding::Linear, "linear"),
        Some(13) => (Encoding::Srgb, "sRGB"),
        other => return Err(format!("its cICP chunk of transfer characteristics {}", other.copied().unwrap_or(0))),
    };
    Ok(Stated::new(encoding, format!("its cICP chunk says {name}")))
}

/// An embedded profile, by its name.
fn of_profile(data: &[u8]) -> Result<Stated, String> {
    let name: String = data.iter().take_while(|b| **b != 0).map(|b| char::from(*b)).collect();
    let told = format!("its colour profile \"{name}\"");
    let plain = name.to_ascii_lowercase();
    let other = ["lin", "g10", "g18", "g22"].iter().any(|word| plain.contains(word));
    if plain.contains("srgb") && !other { Ok(Stated::new(Encoding::Srgb, told)) } else { Err(told) }
}

fn of_srgb() -> Stated {
    Stated::new(Encoding::Srgb, "its sRGB chunk")
}

fn of_gamma(data: &[u8]) -> Result<Stated, String> {
    let stored = data.first_chunk::<4>().map_or(0, |bytes| u32::from_be_bytes(*bytes));
    let encoding = match stored {
        0 => return Err("its gAMA chunk of 0".to_owned()),
        100_000 => Encoding::Linear,
        other => Encoding::Gamma(UNIT / f64::from(other)),
    };
    Ok(Stated::new(encoding, format!("its gAMA chunk says {}", f64::from(stored) / UNIT)))
}

/// The chunks that state an encoding: sRGB, or gAMA with the primaries of sRGB (cHRM). No chunk can state a curve of points or an S-curve: such
/// a picture is meant for a display of sRGB and says so; its side-car states the curve.
pub(crate) fn stating(encoding: &Encoding) -> Vec<([u8; 4], Vec<u8>)> {
    let power = match encoding {
        Encoding::Linear => 1.0,
        Encoding::Gamma(gamma) => 1.0 / gamma,
        _ => return vec![(*b"sRGB", vec![0])], // rendering intent: perceptual
    };
    let stored = (UNIT * power).round().clamp(1.0, f64::from(i32::MAX)) as u32;
    // White, red, green and blue of IEC 61966-2-1: x and y of each.
    let primaries: [u32; 8] = [31_270, 32_900, 64_000, 33_000, 30_000, 60_000, 15_000, 6_000];
    vec![
        (*b"gAMA", stored.to_be_bytes().to_vec()),
        (*b"cHRM", primaries.iter().flat_map(|v| v.to_be_bytes()).collect()),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file of chunks, whose checksums nobody reads here.
    fn png(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let one =
            |(name, data): &(&[u8; 4], &[u8])| [&(data.len() as u32).to_be_bytes()[..], *name, data, &[0; 4]].concat();
        let chunks: Vec<u8> = chunks.iter().flat_map(one).collect();
        [SIGNATURE, &chunks].concat()
    }

    fn encoding(chunks: &[(&[u8; 4], &[u8])]) -> Option<Encoding> {
        said(&png(chunks)).stated.map(|stated| stated.encoding)
    }

    #[test]
    fn each_chunk_is_read_and_the_higher_one_wins() {
        let gamma = 45_455_u32.to_be_bytes();
        assert_eq!(encoding(&[(b"gAMA", &gamma)]), Some(Encoding::Gamma(100_000.0 / 45_455.0)));
        assert_eq!(encoding(&[(b"gAMA", &100_000_u32.to_be_bytes())]), Some(Encoding::Linear));
        assert_eq!(encoding(&[(b"gAMA", &gamma), (b"sRGB", &[0])]), Some(Encoding::Srgb));
        assert_eq!(encoding(&[(b"sRGB", &[0]), (b"cICP", &[1, 8, 0, 1])]), Some(Encoding::Linear));
        assert_eq!(encoding(&[(b"cICP", &[1, 13, 0, 1])]), Some(Encoding::Srgb));
        assert_eq!(encoding(&[(b"cICP", &[1, 1, 0, 1])]), Some(Encoding::bt709()));
        assert_eq!(encoding(&[(b"iCCP", b"sRGB IEC61966-2.1\0\0"), (b"gAMA", &gamma)]), Some(Encoding::Srgb));
        assert_eq!(encoding(&[]), None);
        // What comes behind the picture's data is not said of it.
        assert_eq!(encoding(&[(b"IDAT", &[1]), (b"sRGB", &[0])]), None);
    }

    #[test]
    fn what_is_not_understood_is_named_and_the_next_is_taken() {
        let profile: (&[u8; 4], &[u8]) = (b"iCCP", b"Adobe RGB (1998)\0\0");
        let found = said(&png(&[profile]));
        assert_eq!(found.not_understood.as_deref(), Some("its colour profile \"Adobe RGB (1998)\""));
        assert_eq!(found.stated, None);
        assert_eq!(
            encoding(&[profile, (b"gAMA", &45_455_u32.to_be_bytes())]),
            Some(Encoding::Gamma(100_000.0 / 45_455.0))
        );
        assert!(said(&png(&[(b"cICP", &[9, 16, 0, 1])])).not_understood.is_some_and(|name| name.ends_with(" 16")));
        assert!(said(&png(&[(b"gAMA", &[0; 4])])).not_understood.is_some());
    }

    #[test]
    fn strange_files_say_nothing() {
        assert_eq!(said(b"II\x2a\0"), Said::default());
        let whole = png(&[(b"sRGB", &[0])]);
        assert!((0..whole.len()).all(|length| said(&whole[..length]).not_understood.is_none()));
    }

    #[test]
    fn what_is_written_is_read() {
        for (encoding, read) in [
            (Encoding::Linear, Encoding::Linear),
            (Encoding::Srgb, Encoding::Srgb),
            (Encoding::Gamma(2.5), Encoding::Gamma(2.5)),
            (Encoding::Contrast { contrast: 2.0, midpoint: 0.5 }, Encoding::Srgb),
        ] {
            let chunks = stating(&encoding);
            let chunks: Vec<(&[u8; 4], &[u8])> = chunks.iter().map(|(name, data)| (name, &data[..])).collect();
            assert_eq!(super::said(&png(&chunks)).stated.map(|s| s.encoding), Some(read));
        }
    }
}
