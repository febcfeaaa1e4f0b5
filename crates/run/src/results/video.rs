//! The pictures of a camera's frames as one video, made of their files when all are there.

use crate::result_files::Files;
use etendue_io::OutputFolder;
use etendue_io::failure::Error;
use etendue_io::picture::read_picture;
use etendue_io::y4m::{VideoFacts, write_frame, write_head};
use etendue_pipeline::plan::CameraPlan;
use etendue_scene::asset::{ImageAsset, ImagePixels};
use std::io;
use std::ops::Range;
use std::path::PathBuf;

/// Writes the video, one picture in memory at a time.
pub(super) fn write_video(camera: &CameraPlan, frames: &Range<u32>, folder: &mut OutputFolder) -> Result<(), Error> {
    let format = camera.body.picture_format();
    let file = |frame| folder.readable(&format!("{}/{}", camera.name, Files::picture(frame, format)));
    let files: Vec<PathBuf> = frames.clone().map(file).collect::<Result<_, _>>().map_err(Error::run)?;
    let period_s = camera.timing.period_s.expect("a compiled plan's video has a rate");
    let pitch = camera.body.raster.pitch_mm();
    let name = format!("{}/{}", camera.name, Files::VIDEO);
    let written = folder.write_with(&name, |out| {
        for (i, file) in files.iter().enumerate() {
            let ImageAsset { width, height, pixels, .. } = read_picture(file).map_err(io::Error::other)?;
            let ImagePixels::Rgb8(pixels) = pixels else {
                return Err(io::Error::other(format!("{}: expected a picture of 8 bits in colour", file.display())));
            };
            if i == 0 {
                let (width, height) = (width as usize, height as usize);
                let (frame_rate_hz, pixel_aspect) = (1.0 / period_s, pitch.x / pitch.y);
                write_head(out, &VideoFacts { width, height, frame_rate_hz, pixel_aspect })?;
            }
            write_frame(out, &pixels)?;
        }
        Ok(())
    });
    written.map_err(Error::run)
}
