//! Packages: ZIP archives of uncompressed files.
//!
//! Source: "Usdz File Format Specification" (openusd.org), which allows neither compression nor encryption, and PKWARE's APPNOTE 6.3.

use std::{fmt::Write as _, rc::Rc};

use super::bytes::Bytes;

const END: [u8; 4] = *b"PK\x05\x06";
const CENTRAL: u32 = 0x0201_4b50;
const LOCAL: u32 = 0x0403_4b50;
/// Minimum and maximum size of the end record.
const END_SIZES: [usize; 2] = [22, 22 + 65_535];

/// File of a package.
pub(super) struct Entry {
    pub(super) name: String,
    crc: u32,
    from: usize,
    to: usize,
}

pub(super) struct Package {
    bytes: Vec<u8>,
    entries: Vec<Entry>,
}

impl Package {
    /// Parses a package.
    pub(super) fn new(bytes: Vec<u8>) -> Result<Self, String> {
        let entries = entries(&bytes).map_err(|problem| format!("the package cannot be read: {problem}"))?;
        Ok(Self { bytes, entries })
    }

    /// Bytes of a file in the package.
    pub(super) fn file(&self, name: &str) -> Option<&[u8]> {
        let entry = self.entries.iter().find(|entry| entry.name == name)?;
        Some(&self.bytes[entry.from..entry.to])
    }

    /// Files that are layers, in order.
    pub(super) fn layers(&self) -> impl Iterator<Item = &Entry> {
        self.entries.iter().filter(|entry| is_layer(&entry.name))
    }

    /// Returns a package of the layers alone, without ambiguous content.
    pub(super) fn layers_only(&self) -> Vec<u8> {
        let (mut archive, mut central) = (Vec::new(), Vec::new());
        let mut count = 0_u16;
        for entry in self.layers().take(usize::from(u16::MAX)) {
            let (at, data) = (archive.len() as u32, &self.bytes[entry.from..entry.to]);
            let common = |out: &mut Vec<u8>| {
                // Version 2.0, stored, a date of 1980.
                out.extend([20, 0, 0, 0, 0, 0, 0, 0, 0x21, 0]);
                out.extend(entry.crc.to_le_bytes());
                out.extend([(data.len() as u32).to_le_bytes(), (data.len() as u32).to_le_bytes()].concat());
                out.extend((entry.name.len() as u16).to_le_bytes());
                out.extend([0, 0]);
            };
            archive.extend(LOCAL.to_le_bytes());
            common(&mut archive);
            archive.extend(entry.name.as_bytes());
            archive.extend(data);
            central.extend(CENTRAL.to_le_bytes());
            central.extend([20, 0]);
            common(&mut central);
            central.extend([0; 10]);
            central.extend(at.to_le_bytes());
            central.extend(entry.name.as_bytes());
            count += 1;
        }
        let (at, size) = (archive.len() as u32, central.len() as u32);
        archive.extend(central);
        archive.extend(END);
        archive.extend([0; 4]);
        archive.extend([count.to_le_bytes(), count.to_le_bytes()].concat());
        archive.extend([size.to_le_bytes(), at.to_le_bytes()].concat());
        archive.extend([0; 2]);
        archive
    }

    /// Content, for a message.
    pub(super) fn shown(&self) -> String {
        let mut shown = String::new();
        for entry in self.entries.iter().take(5) {
            write!(shown, "{}\"{}\"", if shown.is_empty() { "" } else { ", " }, entry.name)
                .expect("writing to a String succeeds");
        }
        if self.entries.len() > 5 { format!("{shown} and {} others", self.entries.len() - 5) } else { shown }
    }
}

/// Returns true if a file of a package is a layer.
fn is_layer(name: &str) -> bool {
    [".usd", ".usda", ".usdc"].iter().any(|ending| name.ends_with(ending))
}

fn entries(bytes: &[u8]) -> Result<Vec<Entry>, String> {
    // Offsets have 32 bits.
    if u32::try_from(bytes.len()).is_err() {
        return Err("its size is 4 GiB or more".to_owned());
    }
    let from = bytes.len().saturating_sub(END_SIZES[1]);
    let last = bytes.len().checked_sub(END_SIZES[0]).ok_or("it is not a ZIP archive")?;
    let end = (from..=last).rev().find(|at| bytes[*at..].starts_with(&END)).ok_or("it is not a ZIP archive")?;
    let mut reader = Bytes::new(bytes);
    reader.go(end as u64 + 8)?;
    let count = reader.u16()?;
    reader.u16()?;
    reader.u32()?;
    let directory = reader.u32()?;
    reader.go(directory.into())?;
    let mut list: Vec<Entry> = Vec::new();
    for _ in 0..count {
        list.push(entry(bytes, &mut reader)?);
    }
    // Overlapping files would decompress to more than the package.
    match list.iter().map(|entry| (entry.to - entry.from) as u64).sum::<u64>() <= bytes.len() as u64 {
        true => Ok(list),
        false => Err("its files are larger than the package".to_owned()),
    }
}

fn entry(bytes: &[u8], reader: &mut Bytes<'_>) -> Result<Entry, String> {
    if reader.u32()? != CENTRAL {
        return Err("its directory is damaged".to_owned());
    }
    reader.take(4)?;
    let (flags, method) = (reader.u16()?, reader.u16()?);
    reader.take(4)?;
    let crc = reader.u32()?;
    let (packed, size) = (reader.u32()?, reader.u32()?);
    let [name, extra, comment] = [reader.u16()?, reader.u16()?, reader.u16()?];
    reader.take(8)?;
    let local = reader.u32()?;
    let name = String::from_utf8_lossy(reader.take(name.into())?).into_owned();
    reader.take(u64::from(extra) + u64::from(comment))?;
    if flags & 1 != 0 || method != 0 || packed != size {
        return Err(format!(
            "\"{name}\" is compressed or encrypted, which is not allowed in a package; create it again with usdzip"
        ));
    }
    let mut head = Bytes::new(bytes);
    head.go(local.into())?;
    if head.u32()? != LOCAL {
        return Err(format!("\"{name}\" is not where its directory says"));
    }
    head.take(22)?;
    let skipped = u64::from(head.u16()?) + u64::from(head.u16()?);
    head.take(skipped)?;
    let from = head.at;
    head.take(size.into())?;
    Ok(Entry { name, crc, from, to: head.at })
}

/// File of a package, as a shared buffer.
pub(super) fn packed(package: &Package, name: &str) -> Option<Rc<[u8]>> {
    package.file(name).map(Rc::from)
}
