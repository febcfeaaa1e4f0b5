//! One fault of an input: what is wrong, and where.

use std::fmt;
use std::path::PathBuf;

/// One fault of an input.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// Where it is, what is wrong, what was expected and what to do, in one sentence.
    pub message: String,
    /// The file at fault; `None` where it is an argument's, or not known.
    pub file: Option<PathBuf>,
    /// The line of the file, from 1; `None` where it is of the whole file or of an override, or is not known.
    pub line: Option<u32>,
    /// The column of the line, in characters from 1; `None` where it is not known.
    pub column: Option<u32>,
    /// The dotted key of a description, or an argument as the command line spells it (`--spp`); `None` where there is none.
    pub key: Option<String>,
}

impl Fault {
    /// A fault that only its message places. One that begins with an argument's name is that argument's.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Self {
        let message = message.into();
        let argument = message.split([' ', ':', ',']).next().filter(|word| word.starts_with("--") && word.len() > 2);
        let key = argument.map(str::to_owned);
        Self { message, file: None, line: None, column: None, key }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// The same at a key of a description.
fn at(message: String, place: &etendue_scene::Place) -> Fault {
    let (line, column) = place.line_column().unzip();
    let file = Some(place.stating_file().to_path_buf()).filter(|_| place.is_stated());
    let key = Some(place.key().into_owned()).filter(|key| !key.is_empty());
    Fault { message, file, line, column, key }
}

impl From<&etendue_scene::Fault> for Fault {
    fn from(fault: &etendue_scene::Fault) -> Self {
        at(fault.to_string(), &fault.place)
    }
}

impl From<etendue_scene::Fault> for Fault {
    fn from(fault: etendue_scene::Fault) -> Self {
        Self::from(&fault)
    }
}

/// A path at fault is where it is named; what is wrong in a file is there, with the key that names it.
impl From<etendue_io::Error> for Fault {
    fn from(error: etendue_io::Error) -> Self {
        let named = error.place().map(|place| at(error.to_string(), place));
        match named {
            Some(named) if error.is_of_path() => named,
            named => Self {
                message: error.to_string(),
                file: Some(error.file().to_path_buf()),
                line: error.line().and_then(|line| u32::try_from(line).ok()),
                column: None,
                key: named.and_then(|named| named.key),
            },
        }
    }
}

impl From<String> for Fault {
    fn from(message: String) -> Self {
        Self::new(message)
    }
}

impl From<&str> for Fault {
    fn from(message: &str) -> Self {
        Self::new(message)
    }
}

/// Errors that say what is wrong and not where.
macro_rules! unplaced {
    ($($Error:ty),*) => {
        $(impl From<$Error> for Fault {
            fn from(error: $Error) -> Self {
                Self::new(error.to_string())
            }
        })*
    };
}

unplaced!(
    std::io::Error,
    etendue_charts::ChartError,
    etendue_metrology::calibrate::CalibrateError,
    etendue_metrology::noise::NoiseError,
    etendue_metrology::photon_transfer::TransferError
);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_argument_s_fault_is_told_by_its_name() {
        let key = |message: &str| Fault::new(message).key;
        assert_eq!(key("--time 3: a time of 10 s or more is kept"), Some("--time".to_owned()));
        assert_eq!(key("--corners: expected four of them"), Some("--corners".to_owned()));
        assert_eq!((key("job.toml: --"), key("-- "), key("")), (None, None, None));
    }

    #[test]
    fn a_missing_file_is_a_fault_of_the_key_that_names_it() {
        let folder = tempfile::tempdir().expect("a folder");
        let job = folder.path().join("job.toml");
        let text = "format = 1\n[[scene.meshes]]\nname = \"m\"\nfile = \"lost.obj\"\nup_axis = \"z\"\n[[scene.objects]]\nname = \"o\"\nmesh = \"m\"\n\
            [[cameras]]\nname = \"c\"\nposition_m = [0, 0, 1]\nlook_at_m = [0, 0, 0]\nup = [0, 1, 0]\n[cameras.lens]\ntype = \"pinhole\"\n\
            focal_length_mm = 4\nf_number = 8\n[cameras.sensor]\nwidth_px = 8\nheight_px = 8\npixel_pitch_um = 4\n";
        std::fs::write(&job, text).expect("written");
        let told = crate::Job::open(&job).map(|_| ());
        let Err(crate::Error::Input(faults)) = told else { panic!("{told:?}") };
        let Some(fault) = faults.iter().find(|fault| fault.message.contains("lost.obj")) else { panic!("{faults:?}") };
        assert_eq!((fault.file.as_ref(), fault.line, fault.column), (Some(&job), Some(4), Some(8)), "{fault:?}");
        assert_eq!(fault.key.as_deref(), Some("scene.meshes.m.file"));
    }
}
