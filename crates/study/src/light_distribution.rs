//! Effect of a change on the distribution of light over an image: fall-off towards the corners, and contrast.

use crate::error::Estimate;
use crate::frame_render::RenderPair;
use etendue_core::Plane;
use etendue_core::quantity::WatchedSignal;

/// Side of the cells whose means give the contrast, px.
const CELL_PX: usize = 16;
/// Percentiles of the dark end and of the bright end of the contrast, as fractions of the cells.
const END_PERCENTILES: [f64; 2] = [0.05, 0.95];

/// Combines a figure of two independent renders, the second with `more` times the samples of the first: the mean weighted by samples, and its uncertainty
/// from their difference.
fn pooled([few, many]: [f64; 2], more: f64) -> Option<Estimate> {
    let value = (few + more * many) / (1.0 + more);
    // Variances are σ² and σ²/more: that of the mean is σ²/(1 + more), of the difference σ²(1 + 1/more).
    let uncertainty = (few - many).abs() * more.sqrt() / (1.0 + more);
    value.is_finite().then_some(Estimate { value, uncertainty })
}

/// One figure from both renders of two frames of equal size.
fn compare_distributions(
    own: &RenderPair,
    changed: &RenderPair,
    figure: impl Fn(&Plane<WatchedSignal>, &Plane<WatchedSignal>) -> Option<f64>,
) -> Option<Estimate> {
    let of = |own: &crate::frame_render::FrameRender, changed: &crate::frame_render::FrameRender| {
        let ((kind, a), (other, b)) = own.light.as_ref().zip(changed.light.as_ref())?;
        let fits = kind == other && (a.width(), a.height()) == (b.width(), b.height());
        if fits { figure(a, b) } else { None }
    };
    let few = of(&own.few_samples, &changed.few_samples)?;
    let many = of(&own.many, &changed.many)?;
    pooled([few, many], crate::frame_render::SECOND_SAMPLES_RATIO.into())
}

/// Factor by which the ratio of the light of the corners (an eighth of width and height each) to that of the centre (a quarter of both) changes: 1 if
/// unchanged. `None` if it is dark there, or the light has another size or quantity.
pub(crate) fn change_of_corners(own: &RenderPair, changed: &RenderPair) -> Option<Estimate> {
    compare_distributions(own, changed, |own, changed| {
        let factor = corners_over_middle(changed)? / corners_over_middle(own)?;
        factor.is_finite().then_some(factor)
    })
}

/// Change of (bright − dark)/(bright + dark), where dark and bright are the 5 % and 95 % percentiles of the cells of 16 × 16 px. `None` in the same cases.
pub(crate) fn change_of_contrast(own: &RenderPair, changed: &RenderPair) -> Option<Estimate> {
    compare_distributions(own, changed, |own, changed| Some(contrast(changed)? - contrast(own)?))
}

fn mean(plane: &Plane<WatchedSignal>, [x0, y0]: [usize; 2], [x1, y1]: [usize; 2]) -> f64 {
    let rows = (y0..y1).flat_map(|y| (x0..x1).map(move |x| (x, y)));
    let (sum, count) = rows.fold((0.0, 0.0), |(sum, n), (x, y)| (sum + f64::from(plane.at(x, y)), n + 1.0));
    sum / count
}

fn corners_over_middle(plane: &Plane<WatchedSignal>) -> Option<f64> {
    let (w, h) = (plane.width(), plane.height());
    let (dx, dy) = ((w / 8).max(1), (h / 8).max(1));
    let corner = |x0: usize, y0: usize| mean(plane, [x0, y0], [x0 + dx, y0 + dy]);
    let corners = (corner(0, 0) + corner(w - dx, 0) + corner(0, h - dy) + corner(w - dx, h - dy)) / 4.0;
    let middle = mean(plane, [3 * w / 8, 3 * h / 8], [(5 * w / 8).max(3 * w / 8 + 1), (5 * h / 8).max(3 * h / 8 + 1)]);
    (corners > 0.0 && middle > 0.0).then(|| corners / middle)
}

fn contrast(plane: &Plane<WatchedSignal>) -> Option<f64> {
    let (w, h) = (plane.width(), plane.height());
    let starts = (0..h).step_by(CELL_PX).flat_map(|y| (0..w).step_by(CELL_PX).map(move |x| [x, y]));
    let mut cells: Vec<f64> =
        starts.map(|[x, y]| mean(plane, [x, y], [(x + CELL_PX).min(w), (y + CELL_PX).min(h)])).collect();
    cells.sort_by(f64::total_cmp);
    let [dark, bright] = END_PERCENTILES.map(|part| cells[((cells.len() - 1) as f64 * part).round() as usize]);
    (bright + dark > 0.0).then(|| (bright - dark) / (bright + dark))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(light: impl Fn(usize, usize) -> f32) -> Plane<WatchedSignal> {
        let (w, h) = (64, 48);
        let samples = (0..h).flat_map(|y| (0..w).map(move |x| (x, y))).map(|(x, y)| light(x, y)).collect();
        Plane::from_samples(w, h, samples).expect("one a pixel")
    }

    #[test]
    fn corners_and_contrast_of_known_pictures() {
        let uniform = plane(|_, _| 3.0);
        assert_eq!((corners_over_middle(&uniform), contrast(&uniform)), (Some(1.0), Some(0.0)));
        let halves = plane(|x, _| if x < 32 { 1.0 } else { 3.0 });
        assert_eq!(contrast(&halves), Some(0.5));
        let vignetted = plane(|x, y| if (24..40).contains(&x) && (18..30).contains(&y) { 4.0 } else { 1.0 });
        assert_eq!(corners_over_middle(&vignetted), Some(0.25));
        let dark = plane(|_, _| 0.0);
        assert_eq!((corners_over_middle(&dark), contrast(&dark)), (None, None));
    }

    #[test]
    fn two_renderings_are_weighed_by_their_samples() {
        let pooled = pooled([1.0, 2.0], 3.0).expect("numbers");
        assert!((pooled.value - 1.75).abs() < 1e-12 && (pooled.uncertainty - 3f64.sqrt() / 4.0).abs() < 1e-12);
    }
}
