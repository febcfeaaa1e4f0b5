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
    /// Write where a job's cameras stand and how they project, as ROS, Kalibr and COLMAP know them; nothing is rendered
    Rig(rig::Rig),
    /// Print what will be modelled, what is left out and why, and what it will cost
    Plan(plan::Plan),
    /// Tell what each choice of rendering costs in time and error for a job, and recommend settings
    Tradeoff(tradeoff::Tradeoff),
    /// Make a data set of a job that is varied sample after sample: COCO, KITTI, Cityscapes and others
    Dataset(dataset::Dataset),
    /// Photograph a stored radiance image (rendered with route = "pupil") by another lens and sensor
    Expose(expose::Expose),
    /// Lay fog, rain or snow over a stored radiance image (rendered with route = "pupil"), by its distances
    Weather(weather::Weather),
    /// Make pictures of raws that were taken before, by another processing
    Develop(develop::Develop),
    /// Photograph even light by a camera's bare sensor, or take the series by which EMVA 1288 measures; nothing is traced
    Flat(flat::Flat),
    /// Make a camera file of an EMVA 1288 data sheet; figures that contradict each other are refused
    Datasheet(datasheet::DataSheet),
    /// Write a scene of another program (glTF, pbrt, Mitsuba, USD) as a scene and a job of the format, and what became of what
    Import(import::Import),
    /// Say what is in a file, with units; make a picture of it
    Inspect(inspect::Inspect),
    /// Make a page of a result for a browser: every layer with its values, spectra, histograms, beside another result
    View(view::View),
    /// Compare two results: errors with their uncertainty; exit status 1 where they differ
    Compare(compare::Compare),
    /// Make a test chart as a scene ready to render, with its truth beside it
    Chart(chart::Chart),
    /// Measure a camera: from pictures, or its lens without rendering
    Measure(measure::Measure),
    /// Find a camera's intrinsics and distortion from several pictures of a chart, as a camera file
    Calibrate(calibrate::CalibrateArgs),
    /// Make a camera file of a laboratory folder (dark frames, flats, charts), with every uncertainty and a report as a page
    Characterise(characterise::Characterise),
    /// Photograph a laboratory folder by a camera file: what characterise reads
    Laboratory(laboratory::Laboratory),
    /// Print the JSON Schema of a file kind, for editors
    Schema(schema::Schema),
    /// Explain the code of an error: its cause, an example and what to do
    Explain(explain::Explain),
}
