//! `etendue measure` and `etendue calibrate`: a report of the library to the terminal and to files.

use crate::args::Measure;
use crate::args::measure::calibrate::CalibrateArgs;
use crate::args::measure::report::{CameraOut, ReportArgs};
use crate::machine;
use crate::output::print;
use crate::progress::Terminal;
use etendue::report::Report;
use etendue::{Error, Existing, measure, write_file};

pub fn run(arguments: &Measure) -> Result<(), Error> {
    machine::pool(None)?.install(|| measured(arguments))
}

fn measured(arguments: &Measure) -> Result<(), Error> {
    let observer = &Terminal::default();
    match arguments {
        Measure::Lens(a) => {
            let found = measure::lens(&a.into())?;
            print(&if a.json { format!("{:#}\n", found.json()) } else { found.text() });
            Ok(())
        }
        Measure::Ptc(a) => show_with_camera(&measure::ptc(&a.into(), observer)?, &a.report, &a.out),
        Measure::Sfr(a) => show(&measure::sfr(&a.into())?, &a.input.report),
        Measure::Oecf(a) => show(&measure::oecf(&a.into())?, &a.input.report),
        Measure::Vignetting(a) => show_with_camera(&measure::vignetting(&a.into())?, &a.flat.input.report, &a.out),
        Measure::Shading(a) => show(&measure::shading(&a.into())?, &a.flat.input.report),
        Measure::Noise(a) => show(&measure::noise(&a.into())?, &a.input.report),
        Measure::Flare(a) => show(&measure::flare(&a.into())?, &a.input.report),
        Measure::Colour(a) => show(&measure::colour(&a.into())?, &a.input.report),
        Measure::Cdp(a) => show(&measure::cdp(&a.into())?, &a.input.report),
        Measure::Depth(a) => show(&measure::depth_errors(&a.into())?, &a.report),
        Measure::DarkCurrent(a) => show(&measure::dark_current(&a.into(), observer)?, &a.report),
        Measure::Star(a) => show(&measure::star(&a.into())?, &a.input.report),
        Measure::Texture(a) => show(&measure::texture(&a.into())?, &a.input.report),
        Measure::Distortion(a) => show_with_camera(&measure::distortion(&a.into())?, &a.report, &a.out),
        Measure::Focal(a) => show_with_camera(&measure::focal(&a.into(), observer)?, &a.report, &a.out),
        Measure::Chromatic(a) => show(&measure::chromatic(&a.into())?, &a.report),
        Measure::Compare(a) => {
            let found = measure::compare(&a.into())?;
            show(&found.report, &a.report)?;
            let [one, other] = &found.names;
            match found.differing.is_empty() {
                true => Ok(()),
                false => Err(Error::Run(format!("{one} and {other} differ: {}", found.differing.join(", ")))),
            }
        }
    }
}

/// `etendue calibrate`
pub fn calibrate(arguments: &CalibrateArgs) -> Result<(), Error> {
    let pool = machine::pool(None)?;
    let report = pool.install(|| measure::calibrate(&arguments.into(), &Terminal::default()))?;
    let out = CameraOut { camera_out: arguments.output.clone(), overwrite: arguments.overwrite };
    show_with_camera(&report, &arguments.report, &out)
}

/// Prints a report and draws its plots.
fn show(report: &Report, arguments: &ReportArgs) -> Result<(), Error> {
    if let Some(file) = &arguments.plot {
        write_file(file, report.svg()?.as_bytes(), Existing::Replace)?;
    }
    print(&if arguments.json { format!("{:#}\n", report.json()) } else { report.to_string() });
    Ok(())
}

/// The same, and writes the keys of a camera file where it is asked for.
fn show_with_camera(report: &Report, arguments: &ReportArgs, out: &CameraOut) -> Result<(), Error> {
    if let Some((file, text)) = out.camera_out.as_ref().zip(report.camera_keys()) {
        let existing = if out.overwrite { Existing::Replace } else { Existing::Refuse };
        write_file(file, text.as_bytes(), existing)?;
    }
    show(report, arguments)
}
