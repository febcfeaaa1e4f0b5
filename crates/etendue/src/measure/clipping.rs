//! Readings that are cut: black below, clipped above. What measures grey levels of a region names it, with the part that is cut.

use crate::report::Report;
use etendue_metrology::Image;

/// Part of a region's readings at its least or its greatest above which these are taken for cut.
const CUT_FRACTION: f64 = 0.01;

/// Where the readings of a region are cut.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cut {
    /// All are the same.
    Throughout { reading: f32 },
    /// At 0.
    Black { fraction: f64 },
    /// At the full scale, or where that is not known at the greatest number of 8 or more bits.
    Clipped { reading: f32, fraction: f64 },
}

impl Cut {
    /// Of the readings of a region; `None` where too few are cut to spoil it.
    pub(crate) fn of(region: &Image, full_scale: Option<f64>) -> Option<Self> {
        let samples = region.samples();
        let fraction = |is_cut: &dyn Fn(f32) -> bool| {
            samples.iter().filter(|sample| is_cut(**sample)).count() as f64 / samples.len() as f64
        };
        let (low, high) =
            samples.iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), s| (low.min(*s), high.max(*s)));
        // The greatest number of 8, 10, 12, … bits.
        let is_of_bits = |reading: f32| reading >= 255.0 && (reading as u32 + 1).is_power_of_two();
        let is_full = full_scale.map_or_else(|| is_of_bits(high), |full| f64::from(high) >= full);
        let black = fraction(&|sample| sample <= 0.0);
        let clipped = fraction(&|sample| full_scale.map_or(sample == high, |full| f64::from(sample) >= full));
        match (low == high && (low <= 0.0 || is_full), black > CUT_FRACTION, is_full && clipped > CUT_FRACTION) {
            (true, ..) => Some(Self::Throughout { reading: low }),
            (_, true, _) => Some(Self::Black { fraction: black }),
            (.., true) => Some(Self::Clipped { reading: high, fraction: clipped }),
            _ => None,
        }
    }

    /// In words.
    pub(crate) fn words(self) -> String {
        match self {
            Self::Throughout { reading } => {
                format!("100.0 % of the readings are {reading}, all of them: it is black or white throughout")
            }
            Self::Black { fraction } => {
                format!("{:.1} % of the readings are black, 0 or less: what is darker is cut", 100.0 * fraction)
            }
            Self::Clipped { reading, fraction } => {
                format!("{:.1} % of the readings are clipped at {reading}: what is brighter is cut", 100.0 * fraction)
            }
        }
    }
}

impl Report {
    /// Notes a region whose readings are cut, which the result leaves out.
    pub(crate) fn note_cut(&mut self, name: &str, region: &Image, full_scale: Option<f64>) {
        if let Some(cut) = Cut::of(region, full_scale) {
            self.note(format!("{name}: {}; the result and its uncertainty leave that out", cut.words()));
        }
    }
}

/// A region by its place.
pub(crate) fn region(kind: &str, [x, y, width, height]: [usize; 4]) -> String {
    format!("{kind} {x},{y},{width},{height}")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hundred readings, as many of them cut as stated.
    fn cut(count: usize, reading: f32, full_scale: Option<f64>) -> Option<Cut> {
        let sample = |i: usize| if i < count { reading } else { 100.0 + i as f32 };
        Cut::of(&Image::from_samples(10, 10, (0..100).map(sample).collect()).expect("full rows"), full_scale)
    }

    #[test]
    fn a_region_is_cut_where_more_than_a_hundredth_of_it_is() {
        assert_eq!([cut(0, 0.0, None), cut(1, 0.0, None), cut(1, 255.0, None)], [None; 3]);
        assert_eq!(cut(2, 0.0, None), Some(Cut::Black { fraction: 0.02 }));
        assert_eq!(cut(30, 255.0, None), Some(Cut::Clipped { reading: 255.0, fraction: 0.3 }));
        assert_eq!(cut(30, 250.0, None), None, "no greatest number of any bits");
        assert_eq!(cut(30, 250.0, Some(250.0)), Some(Cut::Clipped { reading: 250.0, fraction: 0.3 }));
        assert_eq!(cut(100, 0.0, None), Some(Cut::Throughout { reading: 0.0 }));
        assert_eq!(cut(100, 128.0, None), None, "an even grey is not cut");
    }

    #[test]
    fn a_report_names_the_region_and_the_part() {
        let mut report = Report::new("test", "test");
        let half = Image::from_samples(2, 1, vec![0.0, 9.0]).expect("a row");
        report.note_cut(&region("trap", [1, 2, 3, 4]), &half, None);
        let told = "trap 1,2,3,4: 50.0 % of the readings are black, 0 or less: what is darker is cut; the result and its uncertainty leave that out";
        assert_eq!(report.notes(), [told]);
    }
}
