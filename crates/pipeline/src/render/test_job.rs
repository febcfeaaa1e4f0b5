//! A job of a static camera, for tests of light accumulation.

use super::exposure::{FilmExposure, FrameCapture};
use super::light::{RaySource, RenderJob, Sampling};
use crate::plan::NumberedPass;
use crate::sizes::block::Blocks;
use crate::sizes::film::FilmLayout;
use crate::sizes::spectrum_spread::SpectrumSpread;
use crate::sizes::tile::Shard;
use etendue_core::{CameraPath, CameraPose};
use glam::{DMat3, DVec3};
use std::sync::LazyLock;

static PATH: LazyLock<CameraPath> =
    LazyLock::new(|| CameraPath::constant(CameraPose { position_m: DVec3::ZERO, rotation: DMat3::IDENTITY }));

/// One pass with wavelengths from 400 to 700 nm, of camera 0.
pub(super) fn sampling(pass: NumberedPass, replicates: u32) -> Sampling {
    Sampling {
        pass,
        replicates,
        seed: 3,
        camera: 0,
        frame_capture: FrameCapture::default(),
        low_nm: 400.0,
        high_nm: 700.0,
        spread: SpectrumSpread::EachReplicate,
    }
}

/// Single pixels with equal numbers of samples, all tiles, of 16 px.
pub(super) fn still_job(
    source: &dyn RaySource,
    [width, height]: [u32; 2],
    layout: FilmLayout,
    sampling: Sampling,
) -> RenderJob<'_> {
    RenderJob {
        source,
        exposure: FilmExposure::still(&PATH),
        width,
        height,
        aperture_px: 1.0,
        layout,
        mosaic: None,
        sampling,
        tolerance: None,
        blocks: Blocks::SINGLE,
        tile_px: 16,
        shard: Shard::WHOLE,
        sample_spread: None,
        scratch: None,
    }
}
