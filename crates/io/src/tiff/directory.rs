//! The image file directory of a TIFF: tags in rising order, then long values, then the strip.

use std::collections::BTreeMap;

/// A tag's value.
#[derive(Clone, Debug)]
pub(super) enum Value {
    Byte(Vec<u8>),
    Text(String),
    Short(Vec<u16>),
    Long(Vec<u32>),
    Rational(Vec<(u32, u32)>),
    SignedRational(Vec<(i32, i32)>),
    /// Where the strip begins.
    StripOffset,
}

/// Tags and their values.
#[derive(Clone, Debug, Default)]
pub(super) struct Directory {
    tags: BTreeMap<u16, Value>,
}

impl Directory {
    pub(super) fn set(&mut self, tag: u16, value: Value) {
        self.tags.insert(tag, value);
    }

    /// The file with its strip.
    pub(super) fn file(&self, strip: &[u8]) -> Vec<u8> {
        let encoded: Vec<_> = self.tags.iter().map(|(tag, value)| (*tag, value.encoded())).collect();
        let after = 8 + 2 + 12 * encoded.len() + 4;
        let long: usize = encoded.iter().map(|(_, e)| e.stored_apart()).sum();
        let strip_at = (after + long) as u32;
        let mut file = b"II\x2a\0\x08\0\0\0".to_vec();
        file.extend((encoded.len() as u16).to_le_bytes());
        let mut apart = Vec::new();
        for (tag, value) in &encoded {
            file.extend(tag.to_le_bytes());
            file.extend(value.kind.to_le_bytes());
            file.extend(value.count.to_le_bytes());
            match &value.bytes {
                None => file.extend(strip_at.to_le_bytes()),
                Some(bytes) if bytes.len() <= 4 => file.extend(padded(bytes, 4)),
                Some(bytes) => {
                    file.extend(((after + apart.len()) as u32).to_le_bytes());
                    apart.extend(padded(bytes, bytes.len().next_multiple_of(2)));
                }
            }
        }
        file.extend([0; 4]);
        file.extend(apart);
        file.extend(strip);
        file
    }
}

fn padded(bytes: &[u8], length: usize) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    bytes.resize(length, 0);
    bytes
}

/// A value as it is stored; no bytes where it is the strip's place.
struct Encoded {
    kind: u16,
    count: u32,
    bytes: Option<Vec<u8>>,
}

impl Encoded {
    fn stored_apart(&self) -> usize {
        self.bytes.as_ref().map_or(0, |bytes| if bytes.len() <= 4 { 0 } else { bytes.len().next_multiple_of(2) })
    }
}

impl Value {
    fn encoded(&self) -> Encoded {
        let with = |kind, count: usize, bytes| Encoded { kind, count: count as u32, bytes: Some(bytes) };
        match self {
            Self::Byte(v) => with(1, v.len(), v.clone()),
            Self::Text(v) => with(2, v.len() + 1, [v.as_bytes(), &[0]].concat()),
            Self::Short(v) => with(3, v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Self::Long(v) => with(4, v.len(), v.iter().flat_map(|v| v.to_le_bytes()).collect()),
            Self::Rational(v) => {
                with(5, v.len(), v.iter().flat_map(|(n, d)| [n.to_le_bytes(), d.to_le_bytes()].concat()).collect())
            }
            Self::SignedRational(v) => {
                with(10, v.len(), v.iter().flat_map(|(n, d)| [n.to_le_bytes(), d.to_le_bytes()].concat()).collect())
            }
            Self::StripOffset => Encoded { kind: 4, count: 1, bytes: None },
        }
    }
}
