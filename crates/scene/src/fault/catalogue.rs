//! The catalogue of errors: every code with its cause, its remedy, and an example. `etendue explain` prints it, and docs/errors.md is generated from
//! it.
//!
//! A code is a kind of error that a user can act on, not a place in the program: the message states the specific problem, the code the general
//! remedy. Examples are run by tests of the program (`explain.rs`): keys are inserted in the small job of its tests, under the name `job.toml`.

use super::code::{Example, Explanation};
use crate::suggest::nearest;
use std::fmt;
use std::str::FromStr;

/// Generates the enum of codes, their words and their explanations from one table.
macro_rules! error_codes {
    ($($Name:ident $word:literal: $cause:literal, $remedy:literal, $example:expr;)*) => {
        /// The kind of an error. Every error of an input or a run has one; [`ErrorCode::explanation`] gives the remedy.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[non_exhaustive]
        pub enum ErrorCode {
            $(#[doc = $cause] $Name,)*
        }

        impl ErrorCode {
            /// All codes, in the order of the catalogue.
            pub const ALL: &'static [Self] = &[$(Self::$Name,)*];

            /// The code as printed and queried: lower-case letters and hyphens.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self {
                    $(Self::$Name => $word,)*
                }
            }

            /// Cause, remedy and an example.
            #[must_use]
            pub const fn explanation(self) -> Explanation {
                match self {
                    $(Self::$Name => Explanation { cause: $cause, remedy: $remedy, example: $example },)*
                }
            }
        }
    };
}
error_codes! {
    InvalidToml "invalid-toml":
        "A file is not valid TOML, for example because a table has a key twice.",
        "Correct the syntax at the line and column.",
        Example::keys("spp = = 8", "spp = 8");
    UnknownFormat "unknown-format":
        "The file states a format version that this program does not support.",
        "Set format = 1 and use the keys of that version, or use the program that the file was written for.",
        Example::keys("format = 2", "format = 1");
    WrongFileKind "wrong-file-kind":
        "A file of one kind is given where another is expected, for example a scene instead of a job.",
        "Give a file of the expected kind: a job has [[cameras]] and a scene, a camera [lens] and [sensor].",
        Example::command("plan camera.toml", "plan job.toml");
    UnknownKey "unknown-key":
        "A table has a key that the format does not define there.",
        "Correct the spelling, or remove the key; docs/scene-format.md lists the keys of each table.",
        Example::keys("focal_lenght_mm = 6", "focal_length_mm = 6");
    MissingKey "missing-key":
        "A table lacks a key that is required, always or together with another key of the table.",
        "Add the key.",
        Example::keys("type = \"thin\"\nf_number = 2", "type = \"thin\"\nfocal_length_mm = 6\nf_number = 2");
    WrongType "wrong-type":
        "A value has another type or form than its key accepts: text instead of a number, a table instead of a list, a list of another length.",
        "Give a value of the type that the message names.",
        Example::keys("f_number = \"two\"", "f_number = 2");
    OutOfRange "out-of-range":
        "A number is outside the range of its key or argument, or outside the range that the other values allow.",
        "Give a number within the range that the message states.",
        Example::keys("exposure_s = -1e-6", "exposure_s = 1e-6");
    UnknownWord "unknown-word":
        "A key accepts one of several words, and the given word is none of them.",
        "Give one of the words that the message lists.",
        Example::keys("type = \"fat\"", "type = \"thin\"");
    UnknownName "unknown-name":
        "A name refers to something that is not defined: a material, mesh, class, frame, camera, glass, illuminant, channel or layer.",
        "Define it, or give one of the names that the message lists.",
        Example::keys("material = \"golt\"", "material = \"gold\"");
    Duplicate "duplicate":
        "Two entries have the same name, time or place, which must be unique.",
        "Rename or remove one of them.",
        Example::keys("name = \"towers\"", "name = \"ball\"");
    WrongOrder "wrong-order":
        "Values that must increase do not, or the end of a range is before its start.",
        "Give the values in increasing order.",
        Example::keys("wavelength_range_nm = [800, 350]", "wavelength_range_nm = [350, 800]");
    WrongCount "wrong-count":
        "A list has too many or too few entries: for example, one is needed for each channel or for each value of another list.",
        "Give as many entries as the message states.",
        Example::keys("white_balance = [1.9, 1]", "white_balance = [1.9, 1, 1.4]");
    NotAMultiple "not-a-multiple":
        "A number cannot be divided evenly: samples by replicates, a side of the image by a scale, a range by a width.",
        "Give a multiple of the number that the message states.",
        Example::keys("spp = 9\nreplicates = 2", "spp = 8\nreplicates = 2");
    NoEffect "no-effect":
        "A key or argument has no effect with the others: it belongs to another option, or to one that is not selected.",
        "Remove it, or select the option that it belongs to.",
        Example::keys("rotation_deg = [0, 0, 0]\nup = [0, 0, 1]", "look_at_m = [6, 0, 0.9]");
    Contradiction "contradiction":
        "Two statements exclude each other, or state the same fact differently.",
        "Keep one of them, or correct the wrong one.",
        Example::keys("look_at_m = [6, 0, 0.9]\nrotation_deg = [0, 0, 0]", "look_at_m = [6, 0, 0.9]");
    CircularReference "circular-reference":
        "A file, frame or element refers to itself, directly or through others.",
        "Remove one of the references of the cycle.",
        Example::keys("format = 1\nbase = \"job.toml\"", "format = 1");
    Empty "empty":
        "A table, list, file or folder that must have content is empty.",
        "Fill it, or remove it.",
        Example::keys("[cameras.effects]\n\n[cameras.isp]", "[cameras.isp]");
    Degenerate "degenerate":
        "Values leave a direction, scale, colour or probability undefined, for example a camera that looks at its own position.",
        "Change one of the values that coincide or are zero.",
        Example::keys("look_at_m = [0, 0, 1.4]", "look_at_m = [6, 0, 0.9]");
    NotModelled "not-modelled":
        "The program does not model this, or not together with something else that is requested.",
        "Choose another model, or leave one of the two out; docs/models.md states what is modelled.",
        Example::keys("[cameras.effects]\nghosts = true\n\n[cameras.lens]", "[cameras.lens]");
    UnavailableOutput "unavailable-output":
        "A requested result is not available from this camera or job, since a sensor, a sequence or a part of the scene is missing.",
        "Add what is missing, or do not request the result.",
        Example::keys("[output]\nvideo = \"y4m\"", "[output]");
    UnsupportedOutput "unsupported-output":
        "The chosen file format cannot store the result.",
        "Choose another file format, or change the result to fit.",
        Example::keys("picture_bits = 16\npicture_format = \"jpeg\"", "white_balance = \"D65\"");
    ImpossibleTiming "impossible-timing":
        "Exposures, row readout and frame period do not fit together.",
        "Shorten the exposure, read out faster, or lower the frame rate.",
        Example::keys("exposure_s = 0.5", "exposure_s = 1e-6");
    UnusableLens "unusable-lens":
        "The lens cannot be used on this sensor: it folds or ends within the image, cannot focus there, or transmits no light.",
        "Correct the numbers of the lens, or make the image smaller.",
        Example::keys("k1 = -9", "k1 = -0.1");
    InvalidChange "invalid-change":
        "A change of a description is not KEY=VALUE, or names an entry that the description does not have.",
        "Give a dotted key, \"=\" and a value.",
        Example::command("plan job.toml `set` render.spp", "plan job.toml `set` render.spp=16");
    MissingFile "missing-file":
        "There is no file or folder of this name.",
        "Correct the path; a path in a file is relative to the folder of that file.",
        Example::keys("file = \"towr.obj\"", "file = \"tower.obj\"");
    UnreadableFile "unreadable-file":
        "The file exists but cannot be read: it is a folder, a pipe or a device, or permission is denied.",
        "Name a regular file that may be read.",
        Example::command("plan scenes", "plan job.toml");
    MalformedFile "malformed-file":
        "The content of a file does not conform to its format: it is damaged, truncated or incorrectly written.",
        "Correct the line, or export or fetch the file again.",
        Example::file("tower.obj", "f 8 5 90", "f 8 5 9");
    UnsupportedFile "unsupported-file":
        "The file is of a format, or uses a feature of its format, that this program does not read.",
        "Convert the file, or store it in one of the formats that the message names.",
        Example::keys("file = \"tower.fbx\"", "file = \"tower.obj\"");
    UnsuitableFile "unsuitable-file":
        "The file can be read, but its content does not fit its use: its size, channels, values or parts differ.",
        "Give a file that fits, or change what uses it.",
        Example::keys("defect_map = \"defects.csv\"", "white_balance = \"D65\"");
    TooLarge "too-large":
        "A file, or its unpacked content, is larger than a limit, or a result is too large for any machine.",
        "Make it smaller, or raise the limit; docs/limits.md lists the limits.",
        Example::command("plan job.toml `limit` mesh-corners=20", "plan job.toml `limit` mesh-corners=1000");
    OutsideFolder "outside-folder":
        "A sandboxed job names a file outside its folder.",
        "Put the file into the folder of the job, or allow its folder with `allow_outside`.",
        Example::command("plan outside.toml `sandboxed`", "plan job.toml `sandboxed`");
    OutputExists "output-exists":
        "A result would replace an existing file.",
        "Choose another path, or allow it with `overwrite`.",
        Example::command("rig job.toml `output` done", "rig job.toml `output` done `overwrite`");
    UnwritableOutput "unwritable-output":
        "A result cannot be written: another file or folder has its name, permission is denied, or the disk is full.",
        "Choose another path, or make this one writable.",
        Example::command("rig job.toml `output` job.toml", "rig job.toml `output` out");
    FolderInUse "folder-in-use":
        "Another run is writing into the folder.",
        "Wait until it ends, or choose another folder.",
        Example::command("rig job.toml `output` busy", "rig job.toml `output` out");
    OtherRun "other-run":
        "The folder contains results, shards or the state of another run: of another job, with other settings, or interrupted.",
        "Give the folders of one run, resume it with `resume`, or start in another folder.",
        Example::command("merge shard `output` out", "merge shard shard2 `output` out");
    NotComparable "not-comparable":
        "Two results cannot be compared: they differ in kind, size or channels.",
        "Give two results of the same kind and size.",
        Example::command("compare checker.png letter.png", "compare checker.png checker.png");
    NotMeasurable "not-measurable":
        "The image or data does not show what is to be measured: no chart or edge is found, it is saturated or too \
         small, or there are fewer images or points than the measurement needs.",
        "Give images that show it, in the number that the message states, or state its position.",
        Example::command("measure sfr checker.png", "measure sfr edge.png");
    NotStated "not-stated":
        "Neither the file nor an argument states a required quantity.",
        "State it by the argument or key that the message names.",
        Example::command("measure oecf checker.png", "measure oecf checker.png `exposures` 1");
    UnknownArgument "unknown-argument":
        "The verb has no such argument, or there is no such verb.",
        "Correct the spelling; the help of the verb lists its arguments.",
        Example::command("rende job.toml", "plan job.toml");
    MissingArgument "missing-argument":
        "A required argument of the verb is missing.",
        "Add it; the help of the verb lists its arguments.",
        Example::command("plan", "plan job.toml");
    InvalidArgument "invalid-argument":
        "The value of an argument cannot be used.",
        "Give a value of the form that the message states.",
        Example::command("plan job.toml `spp` many", "plan job.toml `spp` 16");
    NotEnoughMemory "not-enough-memory":
        "The run needs more memory than is free, or than its limit allows.",
        "Free memory, render fewer pixels, bands or cameras at once, or raise `memory_mb`.",
        Example::command("render job.toml `output` out `memory_mb` 1", "render job.toml `output` out `memory_mb` 0");
}

/// An error whose place the caller knows: its kind and its description.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{words}")]
pub struct Problem {
    /// Its kind.
    pub code: ErrorCode,
    /// Problem and remedy, in words.
    pub words: String,
}

impl Problem {
    /// A problem of this kind.
    pub fn new(code: ErrorCode, words: impl Into<String>) -> Self {
        Self { code, words: words.into() }
    }
}

impl Problem {
    /// Adds words before the description: "WORDS: …".
    #[must_use]
    pub fn within(self, words: impl fmt::Display) -> Self {
        Self { words: format!("{words}: {}", self.words), ..self }
    }
}

/// An error in the content of a file.
impl From<String> for Problem {
    fn from(words: String) -> Self {
        Self::new(ErrorCode::MalformedFile, words)
    }
}

/// An error in the content of a file.
impl From<&str> for Problem {
    fn from(words: &str) -> Self {
        Self::new(ErrorCode::MalformedFile, words)
    }
}

impl fmt::Display for ErrorCode {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.word())
    }
}

/// Error of a word that is no code.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("there is no error code \"{word}\"{}", .nearest.map_or_else(|| "; explain without a code lists all".to_owned(), |code| format!("; did you mean \"{code}\"?")))]
pub struct UnknownCode {
    word: String,
    nearest: Option<ErrorCode>,
}

impl FromStr for ErrorCode {
    type Err = UnknownCode;

    fn from_str(word: &str) -> Result<Self, UnknownCode> {
        let code_of = |word: &str| Self::ALL.iter().copied().find(|code| code.word() == word);
        code_of(word).ok_or_else(|| {
            let words: Vec<&str> = Self::ALL.iter().map(|code| code.word()).collect();
            UnknownCode { word: word.to_owned(), nearest: nearest(word, &words).and_then(code_of) }
        })
    }
}
