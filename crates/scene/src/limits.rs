//! Limits of input files: every limit that a user can raise, in one list.
//!
//! Limits prevent a small or damaged file from filling the memory, and a mistake from running for hours. They belong to the process, as its memory
//! does: the command line raises them (`--limit NAME=N`), descriptions cannot, so that a service can run untrusted jobs. Readers of this crate and of
//! `etendue_io` apply them; docs/limits.md is their page, with the limits that cannot be raised.

use std::sync::atomic::{AtomicU64, Ordering};

use crate::fault::{ErrorCode, Problem};
use crate::suggest::nearest;

#[derive(Debug)]
pub struct Limit {
    /// Name on the command line; it ends in the unit of a size.
    pub name: &'static str,
    /// Limited quantity, in words.
    pub meaning: &'static str,
    /// Default value.
    pub default: u64,
    /// Highest value to which it can be raised.
    pub highest: u64,
    /// Raised value; 0 for the default.
    raised: AtomicU64,
}

const MIB: u64 = 1 << 20;

/// Sizes of description files: a byte may take 256 in memory, as a tree of values that know their places.
pub static DESCRIPTION: Limit = Limit::new(
    "description-mib",
    "MiB of a description file: jobs, scenes, cameras, weather, data sheets, material libraries, lights, lenses, calibrations, side-cars, descriptors",
    16,
    4096,
);

/// Sizes of all other files.
pub static FILE: Limit =
    Limit::new("file-mib", "MiB of any other file: meshes, images, spectra, tables, trajectories", 8192, 1 << 20);

/// Unpacked size of images.
pub static PICTURE: Limit = Limit::new(
    "picture-mib",
    "MiB of an unpacked image, if that is more than 8 times its file: its values as stored in memory, 1 to 4 bytes each",
    1024,
    1 << 20,
);

/// Corners of the faces of a mesh.
pub static CORNERS: Limit =
    Limit::new("mesh-corners", "corners of all faces of a mesh together", 1 << 28, u32::MAX as u64);

/// Unpacked size of meshes with repeated nodes, and of imported scenes.
pub static MESH: Limit = Limit::new(
    "mesh-mib",
    "MiB of a glTF file unpacked to a mesh: nodes may repeat a mesh, primitives share vertices, materials share \
     images; of an unpacked layer of a USD stage, and of its tree of values; of the text of a pbrt scene with its \
     included files; of the output for a pbrt, Mitsuba or USD scene",
    4096,
    1 << 20,
);

/// Length of a chain of files that extend one another.
pub static BASES: Limit = Limit::new("bases", "files in a chain of \"base\" references", 16, 64);

/// Sizes of folders of tiles.
pub static TEXTURE_CACHE: Limit = Limit::new(
    "texture-cache-mib",
    "MiB of the folder of tiles of large textures (`cache`): the least recently used files are removed, and a job whose own tiles need more is refused",
    2048,
    1 << 20,
);

/// All limits.
pub static ALL: [&Limit; 7] = [&DESCRIPTION, &FILE, &PICTURE, &CORNERS, &MESH, &BASES, &TEXTURE_CACHE];

impl Limit {
    const fn new(name: &'static str, meaning: &'static str, default: u64, highest: u64) -> Self {
        Self { name, meaning, default, highest, raised: AtomicU64::new(0) }
    }

    /// Current value, in its unit.
    #[must_use]
    pub fn current(&self) -> u64 {
        match self.raised.load(Ordering::Relaxed) {
            0 => self.default,
            raised => raised,
        }
    }

    /// Current value of a limit in MiB, bytes.
    #[must_use]
    pub fn max_bytes(&self) -> u64 {
        self.current().saturating_mul(MIB)
    }

    /// Suggested value for a need of more than `number`, where the exact need is unknown: twice as much, or the highest.
    #[must_use]
    pub fn suggested(&self, number: u64) -> u64 {
        if number < self.highest { number.saturating_mul(2).min(self.highest) } else { u64::MAX }
    }

    /// End of a message: how to exceed the limit for a need in its unit. A need beyond the highest value cannot be met.
    #[must_use]
    pub fn remedy(&self, needed: u64) -> String {
        match needed <= self.highest {
            true => format!("or raise the limit: `limit` {}={needed}", self.name),
            false => format!("as the limit cannot be raised beyond {}", self.highest),
        }
    }

    /// [`remedy`](Self::remedy) of a limit in MiB, for a need in bytes.
    #[must_use]
    pub fn remedy_bytes(&self, needed: u128) -> String {
        self.remedy(u64::try_from(needed.div_ceil(u128::from(MIB))).unwrap_or(u64::MAX))
    }

    /// Refuses content that would unpack to more than a limit in MiB, with problem and remedy.
    ///
    /// # Errors
    /// The size exceeds the limit.
    pub fn check_unpacked(&self, bytes: u64) -> Result<(), Problem> {
        if bytes <= self.max_bytes() {
            return Ok(());
        }
        let (size, max, remedy) = (bytes.div_ceil(MIB), self.current(), self.remedy_bytes(bytes.into()));
        let words = format!("the file unpacks to {size} MiB, but {max} MiB are allowed; make it smaller, {remedy}");
        Err(Problem::new(ErrorCode::TooLarge, words))
    }

    /// Refuses a file whose size exceeds a limit in MiB, with problem and remedy.
    ///
    /// # Errors
    /// The size exceeds the limit.
    pub fn check_size(&self, bytes: u64) -> Result<(), Problem> {
        if bytes <= self.max_bytes() {
            return Ok(());
        }
        let size = bytes.div_ceil(MIB);
        let (max, remedy) = (self.current(), self.remedy_bytes(bytes.into()));
        let words = format!(
            "the file has {size} MiB, but files of its kind may have at most {max} MiB; make it smaller, {remedy}"
        );
        Err(Problem::new(ErrorCode::TooLarge, words))
    }
}

/// Changes a limit for the whole process: `NAME=N`.
///
/// # Errors
/// There is no such limit, or the number is not from 1 to its highest value.
pub fn set(text: &str) -> Result<(), String> {
    let names = ALL.map(|limit| limit.name);
    let (name, number) = text.split_once('=').ok_or_else(|| format!("expected NAME=N, one of {}", names.join(", ")))?;
    let limit = ALL.into_iter().find(|limit| limit.name == name.trim()).ok_or_else(|| {
        let hint = nearest(name, &names).map_or(String::new(), |near| format!("did you mean \"{near}\"? "));
        format!("unknown limit \"{name}\"; {hint}the limits are {}", names.join(", "))
    })?;
    let legal = number.trim().parse().ok().filter(|n| (1..=limit.highest).contains(n));
    let number = legal.ok_or_else(|| format!("expected a whole number from 1 to {}, not '{number}'", limit.highest))?;
    limit.raised.store(number, Ordering::Relaxed);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_limit_is_reported() {
        assert!(set("picture").expect_err("no number").starts_with("expected NAME=N, one of description-mib,"));
        assert!(set("picture-mb=5").expect_err("no name").contains("did you mean \"picture-mib\"?"));
        assert_eq!(set("bases=0").expect_err("zero"), "expected a whole number from 1 to 64, not '0'");
        assert_eq!(set("bases=65").expect_err("high"), "expected a whole number from 1 to 64, not '65'");
        assert!(ALL.iter().all(|limit| limit.default <= limit.highest && limit.current() == limit.default));
    }

    #[test]
    fn a_message_says_how_far_to_raise() {
        assert!(DESCRIPTION.check_size(16 << 20).is_ok());
        let message = DESCRIPTION.check_size((16 << 20) + 1).expect_err("a byte more");
        assert!(message.words.ends_with("has 17 MiB, but files of its kind may have at most 16 MiB; make it smaller, or raise the limit: `limit` description-mib=17"), "{message}");
        assert_eq!([16, 40, 64].map(|max| BASES.suggested(max)), [32, 64, u64::MAX]);
        assert_eq!(BASES.remedy(65), "as the limit cannot be raised beyond 64");
    }
}
