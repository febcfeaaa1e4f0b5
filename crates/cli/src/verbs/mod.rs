//! The verbs: the closed list, one file each, from its arguments to a call of the library and its answer to the terminal.

mod calibrate;
mod characterise;
mod chart;
mod compare;
mod dataset;
mod datasheet;
mod develop;
mod explain;
mod expose;
mod flat;
mod import;
mod inspect;
mod laboratory;
mod measure;
mod merge;
mod plan;
mod render;
mod rig;
mod schema;
mod tradeoff;
mod view;
mod weather;

use crate::subcommands::subcommands;

subcommands! {
    /// The verbs of the command line.
    Verb:
    /// Render radiance, image, raw and ground truth of a job's cameras
    Render(render::Render),
    /// Join the shards of one job to the result of an unsharded run, byte for byte
    Merge(merge::Merge),
    /// Write poses and projections of a job's cameras for ROS, Kalibr and COLMAP; nothing is rendered
    Rig(rig::Rig),
    /// Print the effects that will be modelled, those left out with reasons, and the estimated cost
    Plan(plan::Plan),
    /// Report time and error of each rendering choice for a job, and recommend settings
    Tradeoff(tradeoff::Tradeoff),
    /// Make a data set from a job varied sample by sample: COCO, KITTI, Cityscapes and others
    Dataset(dataset::Dataset),
    /// Capture a stored radiance image (rendered with route = "pupil") with another lens and sensor
    Expose(expose::Expose),
    /// Add fog, rain or snow to a stored radiance image (rendered with route = "pupil"), by its distances
    Weather(weather::Weather),
    /// Make images from stored raws, with another processing
    Develop(develop::Develop),
    /// Capture uniform illumination with a camera's bare sensor, or the series of EMVA 1288 measurements; nothing is traced
    Flat(flat::Flat),
    /// Make a camera file from an EMVA 1288 data sheet; contradictory values are refused
    Datasheet(datasheet::DataSheet),
    /// Convert a scene of another program (glTF, pbrt, Mitsuba, USD) to a scene and a job of the format, with a conversion report
    Import(import::Import),
    /// Print the content of a file, with units; write it as an image
    Inspect(inspect::Inspect),
    /// Make a page for a browser from a result: every layer with its values, spectra, histograms, next to another result
    View(view::View),
    /// Compare two results: errors with their uncertainty; exit status 1 if they differ
    Compare(compare::Compare),
    /// Make a test chart as a scene ready to render, with reference data
    Chart(chart::Chart),
    /// Measure a camera from images, or its lens without rendering
    Measure(measure::Measure),
    /// Compute a camera's intrinsics and distortion from several images of a chart, as a camera file
    Calibrate(calibrate::CalibrateArgs),
    /// Make a camera file from a laboratory folder (dark frames, flats, charts), with every uncertainty and a report as a page
    Characterise(characterise::Characterise),
    /// Capture a laboratory folder with a camera file: the input of characterise
    Laboratory(laboratory::Laboratory),
    /// Print the JSON Schema of a file kind, for editors
    Schema(schema::Schema),
    /// Explain an error code: cause, example and remedy
    Explain(explain::Explain),
}
