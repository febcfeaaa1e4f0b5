//! `etendue plan`: what will be modelled, what is left out and why, and what it will cost.

use crate::args;
use crate::failure::Failure;
use crate::job::JobRequest;
use crate::machine;
use crate::say;
use etendue_pipeline::summary::Summary;

pub fn run(arguments: &args::Plan) -> Result<(), Failure> {
    let pool = machine::pool(None)?;
    let plan = JobRequest::from(&arguments.job).plan(&pool)?;
    say(&Summary(&plan).to_string());
    Ok(())
}
