//! Parameters of a camera and its views, residuals, and the initial guess.

use etendue_core::maths::f64::exp2;
use etendue_projection::{Calibration, CameraMatrix};
use glam::DVec2;

use super::{CalibrationOptions, Family, Pose, Sightings};
use crate::fit::{Fit, Problem};
use crate::patch_statistics::centroid_shift;

/// Views and the fitted parameters: fx, fy (unless equal), cx, cy (if free), coefficients, then six per view.
#[derive(Clone, Debug)]
pub(super) struct CalibrationProblem<'a> {
    pub(super) views: &'a [Sightings],
    pub(super) size_px: [usize; 2],
    pub(super) family: Family,
    pub(super) options: CalibrationOptions,
    /// Correction subtracted from each sighting, px.
    shifts: Vec<Vec<DVec2>>,
    /// Square roots of weights.
    weights: Vec<Vec<f64>>,
    /// Weight of the stated distance: pixels per unit of relative error.
    distance_weight: f64,
}

/// A camera and the poses of its charts.
pub(super) struct PosedCamera {
    pub(super) calibration: Calibration,
    pub(super) poses: Vec<Pose>,
}

/// Weight of an exact distance: a relative error of 10⁻⁴ counts as one pixel, so that the distance holds to about 10⁻⁵ when
/// points scatter by a tenth of a pixel. A larger weight makes a valley in which the fit hardly moves.
const DISTANCE_WEIGHT: f64 = 1e4;
/// Assumed standard deviation of a coordinate before the fit, px.
const FIRST_SIGMA_PX: f64 = 0.1;

impl<'a> CalibrationProblem<'a> {
    pub(super) fn new(
        views: &'a [Sightings],
        size_px: [usize; 2],
        family: Family,
        options: CalibrationOptions,
    ) -> Self {
        let shifts = views.iter().map(|v| vec![DVec2::ZERO; v.points.len()]).collect();
        let weights = views.iter().map(|v| vec![1.0; v.points.len()]).collect();
        let mut problem = Self { views, size_px, family, options, shifts, weights, distance_weight: DISTANCE_WEIGHT };
        problem.set_weights(FIRST_SIGMA_PX);
        problem
    }

    /// Names of the parameters before those of the views.
    pub(super) fn names(&self) -> Vec<&'static str> {
        let mut names = Vec::new();
        if self.options.focal_px.is_none() {
            names.push("fx_px");
            if !self.options.square_pixels {
                names.push("fy_px");
            }
        }
        if self.options.principal_px.is_none() {
            names.extend(["cx_px", "cy_px"]);
        }
        names.extend(self.family.names());
        names
    }

    /// The parameters of a camera.
    pub(super) fn numbers(&self, matrix: CameraMatrix, coefficients: &[f64]) -> Vec<f64> {
        let initial_value = |name: &str| match name {
            "fx_px" if self.options.square_pixels => Some(0.5 * (matrix.fx + matrix.fy)),
            "fx_px" => Some(matrix.fx),
            "fy_px" => Some(matrix.fy),
            "cx_px" => Some(matrix.cx),
            "cy_px" => Some(matrix.cy),
            _ => None,
        };
        self.names().iter().filter_map(|name| initial_value(name)).chain(coefficients.iter().copied()).collect()
    }

    /// The principal point before the fit: as stated, or the image centre.
    fn principal(&self) -> DVec2 {
        let [width, height] = self.size_px.map(|n| n as f64);
        self.options.principal_px.unwrap_or(DVec2::new(0.5 * width, 0.5 * height))
    }

    /// The camera of the parameters.
    pub(super) fn calibration(&self, parameters: &[f64]) -> Option<Calibration> {
        let names = self.names();
        let at = |name: &str| names.iter().position(|n| *n == name).map(|i| parameters[i]);
        let fx = self.options.focal_px.or_else(|| at("fx_px"))?;
        let fy = at("fy_px").unwrap_or(fx);
        let principal = self.principal();
        let (cx, cy) = (at("cx_px").unwrap_or(principal.x), at("cy_px").unwrap_or(principal.y));
        let coefficients = &parameters[names.len() - self.family.names().len()..names.len()];
        let model = self.family.model(coefficients).ok()?;
        Calibration::new(model, CameraMatrix { fx, fy, skew: 0.0, cx, cy }, self.size_px).ok()
    }

    /// A sighting, corrected for the shift of disc centroids.
    pub(super) fn corrected_position(&self, view: usize, point: usize) -> DVec2 {
        self.views[view].points[point].at - self.shifts[view][point]
    }

    /// Updates the correction for the shift of disc centroids; returns the largest change, px.
    pub(super) fn shift(&mut self, parameters: &[f64]) -> f64 {
        let Some(placed) = self.state(parameters) else { return 0.0 };
        let mut largest: f64 = 0.0;
        for (v, view) in self.views.iter().enumerate() {
            let Some(radius) = view.disc_radius else { continue };
            let map = |chart: DVec2| placed.calibration.project(placed.poses[v].camera(chart));
            for (p, point) in view.points.iter().enumerate() {
                let shift = centroid_shift(map, point.chart, radius).unwrap_or(DVec2::ZERO);
                largest = largest.max((shift - self.shifts[v][p]).length());
                self.shifts[v][p] = shift;
            }
        }
        largest
    }

    /// Sets the weight of the stated distance, which is one observation shared among the views. All together have the weight of a
    /// coordinate whose standard deviation is that of the residuals of the points.
    pub(super) fn weigh_distance(&mut self, fit: &Fit) {
        let points = |v: usize| &fit.residuals[v][..2 * self.views[v].points.len()];
        let squares: f64 = (0..self.views.len()).flat_map(points).map(|r| r * r).sum();
        self.set_weights((squares / fit.degrees_of_freedom as f64).sqrt());
    }

    fn set_weights(&mut self, sigma: f64) {
        if let Some(distance) = self.options.distance.filter(|d| d.standard_uncertainty > 0.0) {
            let each = distance.standard_uncertainty * (self.views.len() as f64).sqrt();
            self.distance_weight = (sigma * distance.value / each).min(DISTANCE_WEIGHT);
        }
    }

    /// Factor on the covariance of a fit with Huber's weights w (Huber 1981, section 6.5, with the means of his matrices). Weighted
    /// least squares state (Σ w d²/ν)/w̄ · (JᵀJ)⁻¹; the covariance is (Σ ψ²/ν)/(mean of ψ′)² · (JᵀJ)⁻¹, where ψ = w d. ψ′ is 1 within
    /// the limit; beyond it, it is w perpendicular to the residual and 0 along it, w/2 on average.
    pub(super) fn widening(&self, fit: &Fit) -> f64 {
        let (mut weighted, mut squares, mut weights, mut slopes, mut count) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (view, residuals) in self.weights.iter().zip(&fit.residuals) {
            for (root, r) in view.iter().zip(residuals.chunks_exact(2)) {
                let (weight, square) = (root * root, r[0] * r[0] + r[1] * r[1]);
                weighted += weight * square;
                squares += square;
                weights += weight;
                slopes += if weight < 1.0 { 0.5 * weight } else { 1.0 };
                count += 1.0;
            }
        }
        if squares > 0.0 { weighted / squares * (weights / count) * (count / slopes) * (count / slopes) } else { 1.0 }
    }

    /// Sets Huber's weights from the residuals of a fit.
    pub(super) fn reweigh(&mut self, fit: &Fit) {
        let distance = |v: usize, p: usize| {
            let [x, y] = [0, 1].map(|c| fit.residuals[v][2 * p + c] / self.weights[v][p]);
            DVec2::new(x, y).length()
        };
        let all: Vec<Vec<f64>> = self
            .views
            .iter()
            .enumerate()
            .map(|(v, view)| (0..view.points.len()).map(|p| distance(v, p)).collect())
            .collect();
        let mut sorted: Vec<f64> = all.iter().flatten().copied().collect();
        sorted.sort_by(f64::total_cmp);
        // The median of a Rayleigh distribution is √(2 ln 2) = 1.1774 σ.
        let sigma = sorted[sorted.len() / 2] / 1.177_41;
        let weight = |d: &f64| if *d > 2.5 * sigma { (2.5 * sigma / d).sqrt() } else { 1.0 };
        self.weights = all.iter().map(|view| view.iter().map(weight).collect()).collect();
    }
}

impl Problem for CalibrationProblem<'_> {
    type State = PosedCamera;

    fn state(&self, parameters: &[f64]) -> Option<PosedCamera> {
        let first = self.names().len();
        let poses = parameters[first..].chunks_exact(6).map(Pose::from_numbers).collect();
        Some(PosedCamera { calibration: self.calibration(parameters)?, poses })
    }

    fn changed(&self, placed: &PosedCamera, parameters: &[f64], changed: usize) -> Option<PosedCamera> {
        let first = self.names().len();
        if changed < first {
            let calibration = self.calibration(parameters)?;
            return Some(PosedCamera { calibration, poses: placed.poses.clone() });
        }
        let view = (changed - first) / 6;
        let mut poses = placed.poses.clone();
        poses[view] = Pose::from_numbers(&parameters[first + 6 * view..][..6]);
        Some(PosedCamera { calibration: placed.calibration.clone(), poses })
    }

    fn blocks(&self) -> usize {
        self.views.len()
    }

    fn residuals(&self, placed: &PosedCamera, view: usize) -> Option<Vec<f64>> {
        let pose = &placed.poses[view];
        let mut residuals = Vec::with_capacity(2 * self.views[view].points.len() + 1);
        for (p, point) in self.views[view].points.iter().enumerate() {
            let off = (placed.calibration.project(pose.camera(point.chart))? - self.corrected_position(view, p))
                * self.weights[view][p];
            residuals.extend(off.to_array());
        }
        residuals.extend(self.options.distance.map(|d| self.distance_weight * (pose.distance() / d.value - 1.0)));
        Some(residuals)
    }

    fn depends(&self, block: usize, parameter: usize) -> bool {
        let first = self.names().len();
        parameter < first || (parameter - first) / 6 == block
    }

    fn reach(&self, parameter: usize) -> f64 {
        let names = self.names();
        let diagonal = DVec2::new(self.size_px[0] as f64, self.size_px[1] as f64).length();
        match names.get(parameter) {
            Some(name) if name.ends_with("_px") => 0.01 * diagonal,
            Some(_) => 0.03,
            None if (parameter - names.len()) % 6 < 3 => 0.03,
            None => {
                let points = &self.views[(parameter - names.len()) / 6].points;
                let centre = points.iter().map(|p| p.chart).sum::<DVec2>() / points.len() as f64;
                0.03 * points.iter().map(|p| (p.chart - centre).length()).fold(0.0, f64::max)
            }
        }
    }
}

/// Initial guess of all parameters; `None` if no focal length is consistent with the charts.
pub(super) fn guess(problem: &CalibrationProblem<'_>) -> Option<Vec<f64>> {
    // From a sixteenth of the image's longer side to sixteen times it, in steps of an eighth of an octave.
    const OCTAVES: i32 = 4;
    const STEPS: i32 = 8;
    let longer = problem.size_px[0].max(problem.size_px[1]) as f64;
    let scanned = (-OCTAVES * STEPS..=OCTAVES * STEPS).map(|i| longer * exp2(f64::from(i) / f64::from(STEPS)));
    let focals: Vec<f64> = problem.options.focal_px.map_or_else(|| scanned.collect(), |f| vec![f]);
    let candidates = focals.into_iter().filter_map(|f| guess_at(problem, f));
    let best = candidates.fold(None, |best: Option<(f64, Vec<f64>)>, candidate| match best {
        Some(best) if best.0 <= candidate.0 => Some(best),
        _ => Some(candidate),
    });
    best.map(|(_, numbers)| numbers)
}

/// The sum of squared distances and the parameters at a focal length.
fn guess_at(problem: &CalibrationProblem<'_>, focal_px: f64) -> Option<(f64, Vec<f64>)> {
    let principal = problem.principal();
    let matrix = CameraMatrix { fx: focal_px, fy: focal_px, skew: 0.0, cx: principal.x, cy: principal.y };
    let mut numbers = problem.numbers(matrix, &problem.family.first());
    let camera = problem.calibration(&numbers)?;
    for view in problem.views {
        let directions = view.points.iter().map(|p| Some((p.chart, camera.unproject(p.at)?)));
        // Points beyond the field of the initial guess are skipped.
        let known: Vec<_> = directions.flatten().collect();
        if 2 * known.len() < view.points.len() {
            return None;
        }
        let pose = Pose::direct(&known)?;
        numbers.extend(pose.numbers());
    }
    let placed = problem.state(&numbers)?;
    let all = (0..problem.blocks()).map(|v| problem.residuals(&placed, v));
    let squares: f64 = all.collect::<Option<Vec<_>>>()?.iter().flatten().map(|r| r * r).sum();
    squares.is_finite().then_some((squares, numbers))
}
