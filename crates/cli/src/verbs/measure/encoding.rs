//! How light follows from the numbers of a picture.

use crate::args::words::chosen;
use clap::Args;
use etendue::measure::{ChosenEncoding, EncodingChoice};

/// What the numbers of a picture are.
#[derive(Clone, Debug, Default, Args)]
pub struct EncodingArgs {
    /// How numbers follow from light: linear, srgb, or a table of two columns: light from 0 to 1 and number over full scale, or exposure above 0
    /// and number (a measured OECF) [default: as the side-car or the PNG says, else by the bits]
    #[arg(long = "encoding", value_name = "linear|srgb|FILE.csv", value_parser = chosen)]
    pub chosen: Option<ChosenEncoding>,
}

impl From<&EncodingArgs> for EncodingChoice {
    fn from(a: &EncodingArgs) -> Self {
        Self { chosen: a.chosen.clone() }
    }
}
