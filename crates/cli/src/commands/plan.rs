//! `etendue plan`: what will be modelled, what is left out and why, and what it will cost.

use super::render::open;
use crate::args;
use crate::machine;
use crate::output::print;
use etendue::Error;

pub fn run(arguments: &args::Plan) -> Result<(), Error> {
    let job = open(&arguments.job, &machine::pool(None)?)?;
    print(&job.summary());
    Ok(())
}
