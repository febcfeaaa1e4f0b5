//! `etendue measure`: the closed list of measurements, one kind a file.

mod cdp;
mod chart_points;
mod chromatic;
mod colour;
mod compare;
mod dark_current;
mod depth;
mod distortion;
mod encoding;
mod flare;
mod flicker;
mod focal;
mod lens;
mod noise;
mod oecf;
mod picture;
mod ptc;
pub mod report;
mod selection;
mod sfr;
mod shading;
mod texture;
mod truth;
pub mod views;

use crate::console::Console;
use crate::machine;
use crate::subcommands::subcommands;
use etendue::Error;

/// `etendue measure`
#[derive(Debug, clap::Args)]
pub struct Measure {
    #[command(subcommand)]
    pub measurement: Measurement,
}

impl Measure {
    pub fn run(&self, console: &dyn Console) -> Result<(), Error> {
        machine::pool(None)?.install(|| self.measurement.run(console))
    }
}

subcommands! {
    /// What is measured.
    Measurement:
    /// Focal lengths, principal planes, pupils and field of view; by field: distortion, illumination, spots, field
    /// curvature, colour
    Lens(lens::LensArgs),
    /// Distortion from one picture of a plane chart, without a model: the curve over the field, line distortion, k1 and k2 (ISO
    /// 17850)
    Distortion(distortion::DistortionArgs),
    /// Focal length and principal point, from one picture of a chart at a known distance or from several
    Focal(focal::FocalArgs),
    /// Lateral chromatic displacement of red and blue against green (ISO 19084)
    Chromatic(chromatic::ChromaticArgs),
    /// Photon transfer after EMVA 1288: gain, quantum efficiency, dark noise, saturation, linearity, DSNU, PRNU
    Ptc(ptc::PtcArgs),
    /// Slanted edges: the spatial frequency response with MTF50 and MTF10 (ISO 12233)
    Sfr(sfr::SfrArgs),
    /// The tone curve from a series of exposures or from steps, with linearity and dynamic range (ISO 14524); the camera's
    /// response from a scene at exposures known relatively
    Oecf(oecf::OecfArgs),
    /// A flat field's fall-off over the radial field position
    Vignetting(shading::VignettingArgs),
    /// A flat field's fall-off as a map, and its colour shading (ISO 17957)
    Shading(shading::ShadingArgs),
    /// Temporal and fixed-pattern noise of an even surface (ISO 15739)
    Noise(noise::NoiseArgs),
    /// Light in traps that send none (ISO 18844)
    Flare(flare::FlareArgs),
    /// Light that goes up and down: frequency, modulation over rows and frames, duty of pulses (IEEE P2020)
    Flicker(flicker::FlickerArgs),
    /// Colours of a ColorChecker after a fitted matrix, CIEDE2000
    Colour(colour::ColourArgs),
    /// Contrast detection probability of pairs of patches (IEEE P2020)
    Cdp(cdp::CdpArgs),
    /// An estimated depth picture against the truth: bias, error and outliers by range, edges apart
    Depth(depth::DepthArgs),
    /// The dark current's growth with temperature, by three laws
    DarkCurrent(dark_current::DarkCurrentArgs),
    /// A Siemens star: response over frequency (ISO 12233)
    Star(texture::StarArgs),
    /// Texture such as dead leaves against its reference: response, invented structure, coherence
    Texture(texture::TextureArgs),
    /// Two cameras' measurements side by side, or a camera file against what was measured; exit status 1 where they differ
    Compare(compare::CompareArgs),
}
