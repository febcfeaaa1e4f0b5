//! Processing of larger pixels: positions and sizes in the image shrink with it; filters that act on neighbouring pixels are unchanged.

use etendue_scene::record::Processing;
use etendue_scene::record::processing::PaperFilter;

/// Converts lengths in pixels to those of the smaller image.
pub(super) fn shrink(isp: &mut Processing, k: f64) {
    let centre = isp.shading.iter_mut().filter_map(|shading| shading.centre_px.as_mut());
    centre.for_each(|centre| centre.value = centre.value.map(|px| px / k));
    isp.image_filters.iter_mut().for_each(|filter| shrink_filter(filter, k));
}

fn shrink_filter(filter: &mut PaperFilter, k: f64) {
    match filter {
        PaperFilter::Glow(glow) => glow.radius_px.value /= k,
        PaperFilter::Drops(drops) => {
            for length in [&mut drops.min_radius_px, &mut drops.max_radius_px, &mut drops.blur_px] {
                length.value /= k;
            }
            drops.flow_px_per_frame.iter_mut().for_each(|flow| flow.value /= k);
        }
        PaperFilter::ToneMap(_)
        | PaperFilter::Colour(_)
        | PaperFilter::PulseNoise(_)
        | PaperFilter::GaussianNoise(_)
        | PaperFilter::UniformNoise(_) => {}
    }
}
