//! Exposure times of a camera's frames, captures and rows.

use super::row_exposure::RowExposure;
use etendue_core::random::{NoiseDraw, NoiseStream, Pixel};
use etendue_core::{Epoch, ExactTime, TimeInterval};

/// Dependence of a camera's light on time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum TimeDependence {
    /// Nothing moves and all lights are constant: one light serves all frames.
    #[default]
    None,
    /// Nothing moves, but lights vary: each row sees their mean over its exposure.
    Lights,
    /// Something moves (possibly the camera, or drops on the glass before it): each sample has a time within its row's exposure.
    Motion,
}

/// Exposure times of a camera's frames, captures and rows, in simulated time since an epoch.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Origin of the other times.
    pub epoch: Epoch,
    /// Start of frame 0 without its jitter, s since the epoch.
    pub start_s: f64,
    /// Frame period, s; `None` if no rate is stated: only frame 0 then has a time.
    pub period_s: Option<f64>,
    /// Random deviation of the start of frames.
    pub jitter: Option<Jitter>,
    /// Exposure of the rows of a frame.
    pub exposure: RowExposure,
}

/// Random deviation of the start of frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jitter {
    /// Maximum deviation to either side, s.
    pub half_width_s: f64,
    /// The job's seed.
    pub seed: u64,
    /// Index of the camera in the job.
    pub camera: u32,
}

impl Timing {
    /// Returns the start of a frame, s since the epoch.
    #[must_use]
    pub fn frame_start_s(&self, frame: u32) -> f64 {
        let deviation = self.jitter.map_or(0.0, |jitter| jitter.deviation_s(frame));
        self.start_s + self.period_s.map_or(0.0, |period_s| f64::from(frame) * period_s) + deviation
    }

    /// Returns the start of a frame.
    #[must_use]
    pub fn frame_start(&self, frame: u32) -> ExactTime {
        self.epoch.time(self.frame_start_s(frame))
    }

    /// Returns the middle of the first capture of a frame: the time of its pose and its ground truth.
    #[must_use]
    pub fn frame_middle(&self, frame: u32) -> ExactTime {
        self.epoch.time(self.capture(frame, 0).middle_s())
    }

    /// Exposure of a row of the sensor in a capture of a frame; a skipped row has that of the nearest row that is read.
    #[must_use]
    pub fn row(&self, frame: u32, capture: usize, row: usize) -> TimeInterval {
        self.exposure.row(capture, row).later(self.frame_start_s(frame))
    }

    /// Interval from the start of the first row to the end of the last in a capture of a frame.
    #[must_use]
    pub fn capture(&self, frame: u32, capture: usize) -> TimeInterval {
        self.exposure.capture(capture).later(self.frame_start_s(frame))
    }
}

impl Jitter {
    fn deviation_s(&self, frame: u32) -> f64 {
        let (origin, kind) = (Pixel { x: 0, y: 0 }, NoiseDraw::TriggerJitter);
        let mut stream = NoiseStream::new(self.seed, self.camera, frame, 0, origin, kind);
        self.half_width_s * (2.0 * stream.unit_f64() - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::super::row_exposure::CaptureTiming;
    use super::*;
    use etendue_core::{RowTiming, Shutter};

    #[test]
    fn frames_captures_and_rows_follow_each_other() {
        let rows = RowTiming { row_time_s: 1e-5, upwards: false, fields: 1 };
        let mut exposure =
            RowExposure { shutter: Shutter::Rolling(rows), first_row: 10, ..RowExposure::global(20, 0.01) };
        exposure.captures.push(CaptureTiming { start_s: 0.01, exposure_ratio: 0.25 });
        assert!((exposure.longest_row_s() - (0.01 + 0.0025)).abs() < 1e-12);
        assert!((exposure.reading_s() - 20e-5).abs() < 1e-12);
        let timing = Timing { epoch: Epoch::default(), start_s: 100.0, period_s: Some(0.04), jitter: None, exposure };
        let row = timing.row(3, 1, 15);
        assert!((row.start_s() - (100.12 + 0.01 + 5e-5)).abs() < 1e-12 && (row.length_s() - 0.0025).abs() < 1e-12);
        assert_eq!(timing.row(3, 1, 0), timing.row(3, 1, 10), "rows that are not read have the time of the nearest");
        let (capture, first, last) = (timing.capture(3, 1), timing.row(3, 1, 10), timing.row(3, 1, 29));
        assert!((capture.start_s() - first.start_s()).abs() < 1e-12 && (capture.end_s() - last.end_s()).abs() < 1e-12);
    }

    #[test]
    fn jitter_is_even_bounded_and_each_frames_own() {
        let jitter = Some(Jitter { half_width_s: 0.002, seed: 5, camera: 1 });
        let timing = Timing {
            epoch: Epoch::default(),
            start_s: 1.0,
            period_s: Some(0.04),
            jitter,
            exposure: RowExposure::global(1, 0.0),
        };
        let deviations: Vec<f64> = (0..4096).map(|k| timing.frame_start_s(k) - 1.0 - 0.04 * f64::from(k)).collect();
        assert!(deviations.iter().all(|d| d.abs() <= 0.002 + 1e-12));
        let n = deviations.len() as f64;
        let mean = deviations.iter().sum::<f64>() / n;
        let square = deviations.iter().map(|d| d * d).sum::<f64>() / n;
        // Uniform over ±a: variance a²/3; of its estimate 4 a⁴/(45 n). Four standard deviations.
        let variance = 0.002_f64 * 0.002 / 3.0;
        assert!(mean.abs() < 4.0 * (variance / n).sqrt());
        assert!((square - variance).abs() < 4.0 * 0.002_f64 * 0.002 * (4.0 / (45.0 * n)).sqrt());
    }
}
