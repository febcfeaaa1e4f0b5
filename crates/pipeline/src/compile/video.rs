//! Whether the pictures of a camera can be written as a video.

use super::context::Context;
use crate::plan::{CameraPlan, PictureFormat};
use etendue_scene::record::Output;

/// Refuses a video of pictures that are not written, have other bits or loss, or follow each other at no stated rate.
pub(super) fn check(output: &Output, camera: &CameraPlan, context: &mut Context<'_>) {
    let Some(key) = &output.video else { return };
    let mut refuse = |lack: String, remedy: &str| {
        let problem = format!("\"video\" is asked for, but {lack}");
        context.fault(&key.place, problem, format!("{remedy}, or remove the key"));
    };
    if camera.body.development.is_none() {
        return refuse("the camera has no [isp], which makes pictures".to_owned(), "add it");
    }
    if !camera.products.picture {
        return refuse("no pictures are, of which it is made".to_owned(), "ask for \"picture\"");
    }
    match camera.body.picture_format() {
        PictureFormat::Png { bits: 8 } => {}
        PictureFormat::Png { bits } => {
            refuse(format!("the pictures have {bits} bits, and its samples have 8"), "write pictures of 8 bits");
        }
        PictureFormat::Jpeg { .. } => {
            refuse(
                "the pictures are JPEG, which has lost what it would repeat".to_owned(),
                "write the pictures as PNG",
            );
        }
    }
    if camera.timing.period_s.is_none() {
        refuse(
            "nothing says how fast frames follow each other".to_owned(),
            "add [sequence] with \"frame_rate_hz\" to the job",
        );
    }
}
