//! `etendue flat` and `etendue datasheet`: sensors by themselves.

use super::render::in_pool;
use crate::args::sensor;
use crate::progress::Terminal;
use etendue::{Error, FlatRequest};

pub fn flat(arguments: &sensor::Flat) -> Result<(), Error> {
    let request = FlatRequest::from(arguments);
    in_pool(|| etendue::flat(&request, arguments.output.folder(), &Terminal::default()))
}

pub fn datasheet(arguments: &sensor::DataSheet) -> Result<(), Error> {
    in_pool(|| etendue::datasheet(&arguments.sheet, arguments.output.folder(), &Terminal::default()))
}
