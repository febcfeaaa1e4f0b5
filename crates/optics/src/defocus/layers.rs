//! Pixels as sources of light, sorted into layers by distance, the nearest first.
//!
//! Layers are equally thick in inverse distance, in which rays through the pupil are straight lines of the picture: a layer is
//! as thick as the distance over which the blur grows by a pixel. Each source keeps its own distance; layers give the order.

use super::PinholeView;
use super::footprint::Footprints;
use super::hidden::{Fill, fills};

/// Layers at most; thicker ones where more would be needed.
const MOST: f64 = 1024.0;

/// Something that shines into the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Source {
    /// The pixel of the view where it is seen.
    pub(super) pixel: u32,
    pub(super) inverse_per_m: f32,
    /// The place in the list of fills of its light; its pixel's own where there is none.
    pub(super) fill: Option<u32>,
}

/// Sources of one layer, by rising pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct Layer {
    pub(super) sources: Vec<Source>,
    /// Pixels that no light of the layer reaches beyond.
    pub(super) reach_px: f64,
}

/// All sources of a view.
#[derive(Clone, Debug)]
pub(super) struct Layers {
    /// The nearest first.
    pub(super) layers: Vec<Layer>,
    pub(super) fills: Vec<Fill>,
}

impl Layers {
    pub(super) fn new(view: &PinholeView<'_>, footprints: &Footprints, inverse_range_per_m: [f64; 2]) -> Self {
        let [far, near] = inverse_range_per_m;
        let count = ((near - far) * footprints.spread_px()).floor().min(MOST - 1.0) + 1.0;
        let per_layer = (near - far) / count;
        let mut layers = vec![Layer::default(); count as usize];
        let place = |inverse: f32| {
            if per_layer == 0.0 {
                0
            } else {
                (((near - f64::from(inverse)) / per_layer) as usize).min(count as usize - 1)
            }
        };
        let seen = (0..view.width() * view.height())
            .filter_map(|i| Some(Source { pixel: i as u32, inverse_per_m: view.inverse_per_m(i)?, fill: None }));
        let fills = fills(view, footprints);
        let hidden = fills.iter().enumerate().map(|(i, fill)| Source {
            pixel: fill.pixel,
            inverse_per_m: fill.inverse_per_m,
            fill: Some(i as u32),
        });
        for source in seen.chain(hidden) {
            let layer = &mut layers[place(source.inverse_per_m)];
            layer.reach_px = layer.reach_px.max(footprints.reach_px(f64::from(source.inverse_per_m)));
            layer.sources.push(source);
        }
        for layer in &mut layers {
            layer.sources.sort_by_key(|source| source.pixel);
        }
        Self { layers, fills }
    }
}

impl Layer {
    /// The sources in rows `first` to before `end`, of `width` pixels each.
    pub(super) fn rows(&self, first: usize, end: usize, width: usize) -> &[Source] {
        let before = |row: usize| self.sources.partition_point(|s| (s.pixel as usize) < row * width);
        &self.sources[before(first)..before(end)]
    }
}
