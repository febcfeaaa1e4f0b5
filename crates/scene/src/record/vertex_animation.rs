//! Meshes with moving vertices, from one file for each of several times.

use etendue_core::{Cycle, Epoch, ExactTime};

use std::path::PathBuf;

use crate::fault::{DescriptionErrors, ErrorCode};
use crate::numbered_files::{numbered, parts};
use crate::place::Placed;
use crate::reader::{choice, integer, keyed, list, number, path, record, time, words};

record! {
    /// Vertex animation: the same mesh in several files, one for each time. Every vertex moves straight and at constant speed between two files.
    pub struct VertexAnimation check(check) {
        /// Numbered Wavefront OBJ files (`%d`, `%03d`) with equal faces; texture coordinates and materials of the first.
        required files: Placed<PathBuf> = path(&["obj"]);
        /// First number. Default: 0.
        optional first: Placed<u64> = integer(0, 999_999_999);
        /// Number of files.
        required count: Placed<u64> = integer(2, 100_000);
        /// Times of the files.
        inside times: FrameTimes;
        /// Offset added to all times. Default: 0.
        optional time_offset_s: Placed<ExactTime> = time();
        /// Behaviour outside the files' times. Default: "hold".
        optional repeat: Placed<FrameRepeat> = choice();
    }
}

keyed! {
    /// Times of the files.
    pub enum FrameTimes {
        /// Files per second, the first at 0 s; in a loop it recurs one step after the last.
        rate_hz => Rate(Placed<f64>) = number("Hz").above(0.0).at_most(1e6);
        /// Increasing times, one per file; a loop has one more, at which the first recurs.
        times_s => Times(Vec<Placed<ExactTime>>) = list(time(), 2);
    }
}

words! {
    /// Behaviour after the last file of moving vertices and before the first.
    pub enum FrameRepeat {
        /// Holds the last file, and the first before its time.
        "hold" => Hold,
        /// Repeats from the first file, also before its time.
        "loop" => Loop,
    }
}

impl VertexAnimation {
    /// The files in the order of their times.
    #[must_use]
    pub fn frame_files(&self) -> Vec<Placed<PathBuf>> {
        let first = self.first.as_ref().map_or(0, |first| first.value);
        let file = |number: u64| Placed::new(numbered(&self.files.value, number), self.files.place.clone());
        (first..first + self.count.value).map(file).collect()
    }

    /// Behaviour after the last file.
    #[must_use]
    pub fn repeats(&self) -> FrameRepeat {
        self.repeat.as_ref().map_or(FrameRepeat::Hold, |repeat| repeat.value)
    }

    /// Time of each file since the epoch, s; for a loop also the time at which the first recurs. A loop far from the epoch is shifted by whole
    /// periods to near it.
    #[must_use]
    pub fn frame_times_s(&self, epoch: Epoch) -> Vec<f64> {
        let offset = self.time_offset_s.as_ref().map_or(ExactTime::default(), |offset| offset.value) - epoch.start();
        let times: Vec<ExactTime> = match &self.times {
            FrameTimes::Rate(rate) => {
                (0..self.times_needed()).map(|i| offset + (i as f64 / rate.value).into()).collect()
            }
            FrameTimes::Times(times) => times.iter().map(|time| offset + time.value).collect(),
        };
        let (first, last) = (times[0], times[times.len() - 1]);
        let cycle = match &self.times {
            FrameTimes::Rate(rate) => Cycle::Events { rate_hz: rate.value, count: self.count.value as u32 },
            FrameTimes::Times(_) => Cycle::Period((last - first).seconds()),
        };
        let moved = match self.repeats() {
            FrameRepeat::Loop => ExactTime::from(cycle.reduced_s(first)) - first,
            FrameRepeat::Hold => ExactTime::default(),
        };
        times.into_iter().map(|time| (time + moved).seconds()).collect()
    }

    fn times_needed(&self) -> u64 {
        self.count.value + u64::from(self.repeats() == FrameRepeat::Loop)
    }
}

fn check(animation: &VertexAnimation, errors: &mut DescriptionErrors) {
    let name = animation.files.value.file_name().unwrap_or_default().to_string_lossy();
    if parts(&name).is_none() {
        let problem = format!("\"{name}\" must contain exactly one placeholder for the file number");
        errors.add(
            ErrorCode::MissingKey,
            &animation.files.place,
            problem,
            "write %d for the number, or %03d for three digits",
        );
    }
    let FrameTimes::Times(times_s) = &animation.times else { return };
    check_times(animation, times_s, errors);
}

fn check_times(animation: &VertexAnimation, times_s: &[Placed<ExactTime>], errors: &mut DescriptionErrors) {
    let (count, needed, files) = (times_s.len(), animation.times_needed(), animation.count.value);
    if count as u64 != needed {
        let problem = match animation.repeats() {
            FrameRepeat::Hold => format!("the number of times is {count}; each of the {files} files needs one"),
            FrameRepeat::Loop => {
                format!(
                    "the number of times is {count}; a loop of {files} files needs one for each and one for the return of the first"
                )
            }
        };
        errors.add(ErrorCode::WrongCount, &times_s[0].place, problem, format!("give {needed} times"));
    }
    let unsorted = times_s.windows(2).filter(|pair| pair[1].value <= pair[0].value);
    for pair in unsorted {
        let problem = format!("the time {} s follows {} s", pair[1].value, pair[0].value);
        errors.add(ErrorCode::WrongOrder, &pair[1].place, problem, "give the times in increasing order");
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::place::Place;

    /// A loop of 0.4 s that began at 0 s has the same phase after any number of periods; a held animation is long over.
    #[test]
    fn loops_keep_their_phase_at_unix_times() {
        let animation = |repeat: FrameRepeat| VertexAnimation {
            place: Place::unstated(),
            files: PathBuf::from("a_%d.obj").into(),
            first: None,
            count: 10.into(),
            times: FrameTimes::Rate(25.0.into()),
            time_offset_s: None,
            repeat: Some(repeat.into()),
        };
        let epoch = Epoch::near("1700000000.1".parse().expect("a time"));
        // 1.7e9 s are 4.25e9 periods.
        let near = animation(FrameRepeat::Loop).frame_times_s(Epoch::default());
        let distant = animation(FrameRepeat::Loop).frame_times_s(epoch);
        // Sums and differences with whole seconds below 2^31 round to 2^-53 of a second each.
        assert!(
            near.len() == distant.len() && near.iter().zip(&distant).all(|(a, b)| (a - b).abs() < 1e-15),
            "{distant:?}"
        );
        assert_eq!(animation(FrameRepeat::Hold).frame_times_s(epoch)[0], -1.7e9);
    }
}
