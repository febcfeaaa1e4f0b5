//! Layers of an EXR, and an image of one.
//!
//! A layer is a channel by its full name, or the common part of several channel names before the last dot: `flow.forward` of `flow.forward.X` and
//! `flow.forward.Y`, `N` of `N.X`, `N.Y`, `N.Z`, `depth` of `depth.Z`.

use super::Preview;
use super::drawing::{draw_differences, draw_flow, draw_identities, draw_lengths, draw_vectors};
use crate::exr::{ExrFile, ExrSamples};

/// Image of a layer and a sentence on its content; `None` if the file has no such layer.
pub(super) fn layer_preview(exr: &ExrFile, name: &str) -> Option<(Preview, String)> {
    let part = |letter: &str| exr.channel(&format!("{name}.{letter}")).map(ExrSamples::to_floats);
    let (rgb, note) = match (part("X"), part("Y"), part("Z")) {
        (Some(x), Some(y), Some(z)) => vectors(name, [&x, &y, &z]),
        (Some(u), Some(v), None) => flow(name, [&u, &v]),
        _ => return single(exr, name),
    };
    Some((Preview { width: exr.width, height: exr.height, rgb }, note))
}

/// Names of the layers, sorted, each once.
pub(super) fn names(exr: &ExrFile) -> Vec<&str> {
    let mut names: Vec<&str> =
        exr.channels.iter().map(|c| c.name.rsplit_once('.').map_or(c.name.as_str(), |(layer, _)| layer)).collect();
    names.sort_unstable();
    names.dedup();
    names
}

fn flow(name: &str, [u, v]: [&[f32]; 2]) -> (Vec<[u8; 3]>, String) {
    let (rgb, scale) = draw_flow(u, v);
    let unit = match name {
        "motion_vector" => " px/s",
        name if name.starts_with("flow") => " px",
        _ => "",
    };
    (rgb, wheel_note(name, scale, unit))
}

/// Note on an image of flow.
pub(super) fn wheel_note(name: &str, scale: f32, unit: &str) -> String {
    format!(
        "the image shows {name} on the colour wheel of Baker et al. 2011 (right red, down yellow, left cyan, up violet), full saturation at \
         {scale:.4}{unit}, darker beyond; black: unknown"
    )
}

fn vectors(name: &str, components: [&[f32]; 3]) -> (Vec<[u8; 3]>, String) {
    let (rgb, scale) = draw_vectors(components, name == "N");
    (rgb, format!("the image shows {name}: x, y, z as red, green, blue, from {:.4} to {scale:.4}", -scale))
}

fn single(exr: &ExrFile, name: &str) -> Option<(Preview, String)> {
    let (width, height) = (exr.width, exr.height);
    let matching =
        exr.channels.iter().find(|c| c.name == name || c.name.rsplit_once('.').is_some_and(|(l, _)| l == name));
    let channel = matching?;
    let (rgb, message) = match &channel.samples {
        ExrSamples::Uint(ids) => {
            (draw_identities(ids), format!("the image shows {}, one colour per value", channel.name))
        }
        samples if channel.name.ends_with(".Z") => lengths(&channel.name, &samples.to_floats()),
        samples => {
            let message = format!("the image shows channel {}", channel.name);
            return Some((Preview::from_grey(width, height, &samples.to_floats()), message));
        }
    };
    Some((Preview { width, height, rgb }, message))
}

fn lengths(name: &str, values: &[f32]) -> (Vec<[u8; 3]>, String) {
    let (rgb, [near, far]) = draw_lengths(values);
    let message = format!(
        "the image shows {name} in the viridis colour map, logarithmic, from {near:.4} (yellow) to {far:.4} (violet); white: infinite"
    );
    (rgb, message)
}

/// Image of disparities or other numbers of one channel.
pub(super) fn differences(width: usize, height: usize, values: &[f32]) -> (Preview, String) {
    let (rgb, [low, high]) = draw_differences(values);
    let message = format!(
        "the image shows the numbers in the viridis colour map, from {low:.4} (violet) to {high:.4} (yellow); white: infinite"
    );
    (Preview { width, height, rgb }, message)
}
