//! The readers: the closed list. A reader that is added to Étendue is added here.

mod assets;
mod calibrations;
mod descriptions;
mod pictures;
mod results;
mod scenes;
mod seeds;
mod target;
#[cfg(feature = "usd")]
mod usd;

pub use target::Target;

/// All of them.
pub const TARGETS: &[Target] = &[
    descriptions::JOB,
    descriptions::SCENE,
    descriptions::CAMERA,
    descriptions::WEATHER,
    descriptions::VARIATIONS,
    descriptions::DATASHEET,
    descriptions::SET,
    descriptions::PLAN,
    assets::OBJ,
    assets::GLB,
    assets::GLTF,
    assets::PLY,
    scenes::PBRT,
    scenes::MITSUBA,
    #[cfg(feature = "usd")]
    usd::USD,
    #[cfg(feature = "usd")]
    usd::USDZ,
    scenes::GLTF_SCENE,
    assets::MTL,
    assets::MESH_FRAME,
    assets::IES,
    assets::LDT,
    assets::ZMX,
    assets::SEQ,
    assets::FIELD_TABLE,
    assets::RAY_TRANSFER,
    assets::SPECTRUM,
    assets::COMPLEX_INDEX,
    assets::RETRO_TABLE,
    assets::NUMBERS,
    assets::TRAJECTORY_CSV,
    assets::TRAJECTORY_JSON,
    calibrations::OPENCV,
    calibrations::ROS,
    calibrations::KALIBR,
    calibrations::EUROC,
    calibrations::CAMODOCAL,
    calibrations::COLMAP,
    calibrations::COLMAP_BINARY,
    calibrations::OCAM,
    calibrations::F_THETA,
    pictures::EXR,
    pictures::SPECTRAL_EXR,
    pictures::PNG,
    pictures::JPEG,
    pictures::TIFF,
    pictures::DNG,
    pictures::HDR,
    pictures::PFM,
    pictures::FLO,
    results::SIDE_CAR,
    results::EMVA,
    results::POINTS,
    results::TRUTH,
    results::FILM,
    results::MANIFEST,
];

/// The target of a name.
#[must_use]
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}
