//! WebDataset (Aizman et al. 2019): shards in tar, `webdataset/SPLIT-NNNNNN.tar`, of `shard_samples` samples each, in order.
//!
//! Each image has four members with one stem: the image, `.json` (its record: camera, pose, boxes, masks), `.instance.png` (identities of the ground truth, 16
//! bits), `.depth.npy` (32-bit floats, m; +∞ for sky, NaN where there is none). Each sample is first written as a part, an archive in `webdataset/parts`. At the
//! end of a run the parts are joined to shards. The parts of complete shards are then removed; those of incomplete shards stay for a resumed run.
//!
//! Archives are POSIX ustar (IEEE 1003.1-1988) without owners and times, so that equal files give equal bytes.

use std::io::{self, Read as _, Seek as _, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::{cell::RefCell, collections::BTreeMap, fs::File, ops::Range};

use etendue::{Error, ErrorCode, FileDigest, OutputFolder};
use etendue_core::Plane;
use etendue_core::quantity::{Identity, Length};
use etendue_io::png::encode_grey16;
use serde_json::json;

use crate::records::{FormatWriter, Records, write};
use crate::{draw::Split, picture::SampleImage, record::SampleRecord, set::Set};

pub(super) struct WebDataset {
    shard_samples: u32,
    /// Files of the current sample.
    part: RefCell<Vec<u8>>,
    /// Layout of the last requested shard.
    layout: RefCell<Option<ShardLayout>>,
}

/// Places of the samples' parts in a shard, from their records.
struct ShardLayout {
    shard: u32,
    /// Offset by sample.
    starts: BTreeMap<u32, u64>,
    /// Bytes of all parts.
    lengths: BTreeMap<Split, u64>,
}

/// Samples of a shard with parts, by split and the shard's number.
type Shards = BTreeMap<(Split, u32), Vec<u32>>;

impl WebDataset {
    pub(super) fn new(set: &Set) -> Self {
        let stated = set.variations.as_ref().and_then(|variations| variations.shard_samples.as_ref());
        // At most a million.
        Self {
            shard_samples: stated.map_or(1000, |count| count.value as u32),
            part: RefCell::default(),
            layout: RefCell::default(),
        }
    }

    fn shards(&self, records: &Records) -> Result<Shards, Error> {
        let mut shards = Shards::new();
        for record in records.each() {
            let SampleRecord { sample, split, .. } = record.map_err(Error::run)?;
            shards.entry((split, sample / self.shard_samples)).or_default().push(sample);
        }
        Ok(shards)
    }

    /// Layout of a shard, by its records up to the first that cannot be read.
    fn shard_layout(&self, records: &Records, shard: u32) -> ShardLayout {
        let (mut starts, mut lengths) = (BTreeMap::new(), BTreeMap::new());
        for sample in records.numbers().iter().filter(|sample| **sample / self.shard_samples == shard) {
            let Ok(record) = records.read(*sample) else { break };
            let end = lengths.entry(record.split).or_insert(0);
            starts.insert(*sample, *end);
            *end += record.files.get(&part(*sample)).map_or(0, |part| part.bytes);
        }
        ShardLayout { shard, starts, lengths }
    }

    /// Returns true if all samples of a shard are present.
    fn is_complete(&self, records: &Records, shard: u32) -> bool {
        let count = records.numbers().iter().filter(|sample| **sample / self.shard_samples == shard).count();
        count == self.shard_samples as usize
    }
}

fn part(sample: u32) -> String {
    format!("webdataset/parts/{sample:06}.tar")
}

fn parts(folder: &OutputFolder, samples: &[u32]) -> Vec<PathBuf> {
    samples.iter().map(|sample| folder.path().join(part(*sample))).collect()
}

impl FormatWriter for WebDataset {
    /// Refuses to replace some samples of a complete shard: its parts are removed, so that all its samples must be rendered again.
    fn check_replaced(&self, records: &Records, samples: &Range<u32>, folder: &OutputFolder) -> Result<(), Error> {
        let shard = |sample: u32| sample / self.shard_samples;
        let lost = |sample: &&u32| !samples.contains(sample) && !folder.path().join(part(**sample)).exists();
        let is_touched = |sample: &&u32| (shard(samples.start)..=shard(samples.end - 1)).contains(&shard(**sample));
        let Some(sample) = records.numbers().iter().filter(is_touched).find(lost) else { return Ok(()) };
        let (first, end) = (shard(*sample) * self.shard_samples, (shard(*sample) + 1) * self.shard_samples);
        Err(Error::argument(
            "samples",
            format!(
                "`samples` {}..{}: the shard of samples {first} to {} is complete, and its samples can only be made again together; give `samples` \
                 {first}..{end} with `overwrite`, or `resume`",
                samples.start,
                samples.end,
                end - 1
            ),
        ).with_code(ErrorCode::OtherRun))
    }

    /// Returns true if the part of a sample, by length and digest, is a section of the complete shard that has replaced it.
    fn has_file(&self, name: &str, record: &SampleRecord, records: &Records, root: &Path) -> bool {
        let Some(digest) = record.files.get(name).filter(|_| name == part(record.sample)) else { return false };
        let shard = record.sample / self.shard_samples;
        let mut layout = self.layout.borrow_mut();
        if layout.as_ref().is_none_or(|known| known.shard != shard) {
            *layout = Some(self.shard_layout(records, shard));
        }
        let Some(ShardLayout { starts, lengths, .. }) = &*layout else { return false };
        let (Some(start), Some(length)) = (starts.get(&record.sample), lengths.get(&record.split)) else {
            return false;
        };
        let tar = root.join(format!("webdataset/{}-{shard:06}.tar", record.split.name()));
        let piece = File::open(&tar).and_then(|mut file| {
            file.seek(SeekFrom::Start(*start))?;
            FileDigest::from_reader(file.take(digest.bytes))
        });
        let is_of_length = tar.metadata().is_ok_and(|info| info.len() == length + END.len() as u64);
        is_of_length && piece.is_ok_and(|actual| actual == *digest)
    }

    fn write_image(&self, _set: &Set, image: &SampleImage<'_>, _folder: &mut OutputFolder) -> Result<(), Error> {
        let (sample, _) = image.sample;
        let record = &image.record;
        let stem = record.stem(sample);
        let failed = |error: &dyn std::fmt::Display| Error::Run(format!("{stem}: {error}"));
        let facts = json!({ "sample": sample, "picture": record }).to_string();
        let ids = identities(&image.truth.instance).map_err(|error| failed(&error))?;
        let mut part = self.part.borrow_mut();
        for (extension, bytes) in [
            (record.extension.as_str(), image.bytes.as_slice()),
            ("json", facts.as_bytes()),
            ("instance.png", &ids),
            ("depth.npy", &npy(&image.truth.depth)),
        ] {
            add(&mut part, &format!("{stem}.{extension}"), bytes);
        }
        Ok(())
    }

    fn sample(&self, _set: &Set, record: &SampleRecord, folder: &mut OutputFolder) -> Result<(), Error> {
        write(folder, &part(record.sample), &self.part.take())
    }

    fn finish(&self, _set: &Set, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        for ((split, shard), samples) in self.shards(records)? {
            let parts = parts(folder, &samples);
            // A complete shard has replaced its parts.
            let name = format!("webdataset/{}-{shard:06}.tar", split.name());
            let is_made = self.is_complete(records, shard) && parts.iter().all(|part| !part.exists());
            if is_made && folder.path().join(&name).exists() {
                continue;
            }
            folder.write_with(&name, |file| joined(&parts, file)).map_err(Error::run)?;
        }
        Ok(())
    }

    fn remove_obsolete(&self, records: &Records, folder: &mut OutputFolder) -> Result<(), Error> {
        for ((_, shard), samples) in self.shards(records)? {
            if self.is_complete(records, shard) {
                let names: Vec<String> = samples.iter().map(|sample| part(*sample)).collect();
                folder.remove(names.iter().map(String::as_str)).map_err(Error::run)?;
            }
        }
        Ok(())
    }
}

fn joined(parts: &[PathBuf], file: &mut impl Write) -> io::Result<()> {
    for part in parts {
        let unread = |cause: io::Error| io::Error::other(format!("{}: {cause}", part.display()));
        io::copy(&mut File::open(part).map_err(unread)?, file)?;
    }
    file.write_all(&END)
}

fn identities(ids: &Plane<Identity>) -> Result<Vec<u8>, String> {
    let narrow = |id: &u32| u16::try_from(*id).map_err(|_| format!("identity {id} is beyond 16 bits"));
    let narrow = ids.samples().iter().map(narrow).collect::<Result<Vec<u16>, _>>()?;
    encode_grey16(ids.width(), ids.height(), &narrow).map_err(|error| error.to_string())
}

/// NumPy's format 1.0: a header that ends at a multiple of 64 bytes, and the numbers in little-endian order, row by row.
fn npy(plane: &Plane<Length>) -> Vec<u8> {
    let (height, width) = (plane.height(), plane.width());
    let facts = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    let length = (10 + facts.len() + 1).next_multiple_of(64) - 10;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend_from_slice(&(length as u16).to_le_bytes());
    bytes.extend_from_slice(format!("{facts:<width$}\n", width = length - 1).as_bytes());
    plane.samples().iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    bytes
}

/// Bytes per block.
const BLOCK: usize = 512;
/// End of an archive: two empty blocks.
const END: [u8; 2 * BLOCK] = [0; 2 * BLOCK];
/// Longest name, bytes.
const MAX_NAME: usize = 100;

/// Adds a file; an archive is files and [`END`].
///
/// # Panics
/// If the name is longer than 100 bytes.
pub(crate) fn add(archive: &mut Vec<u8>, name: &str, bytes: &[u8]) {
    assert!(name.len() <= MAX_NAME, "a name of at most {MAX_NAME} bytes: {name}");
    let mut head = [0; BLOCK];
    put(&mut head, 0, name.as_bytes());
    put(&mut head, 100, b"0000644\0");
    put(&mut head, 108, b"0000000\0");
    put(&mut head, 116, b"0000000\0");
    put(&mut head, 124, format!("{:011o}\0", bytes.len()).as_bytes());
    put(&mut head, 136, b"00000000000\0");
    // The checksum is that of the header with blanks in its place.
    put(&mut head, 148, b"        ");
    put(&mut head, 156, b"0");
    put(&mut head, 257, b"ustar\x0000");
    let sum: u32 = head.iter().map(|byte| u32::from(*byte)).sum();
    put(&mut head, 148, format!("{sum:06o}\0 ").as_bytes());
    archive.extend_from_slice(&head);
    archive.extend_from_slice(bytes);
    archive.resize(archive.len().next_multiple_of(BLOCK), 0);
}

fn put(head: &mut [u8; BLOCK], at: usize, bytes: &[u8]) {
    head[at..at + bytes.len()].copy_from_slice(bytes);
}
