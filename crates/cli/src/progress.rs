//! Progress and messages while a task runs: bars on a terminal, elsewhere one line per minute. Ctrl-C stops by the operating system's default.

use crate::console::Console;
use crate::output::{print, print_json, print_message};
use etendue::{Message, Observer, Progress, ProgressUnit, terminal_text};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::Mutex;
use std::time::Instant;

/// Draws a bar for each task on stderr if that is a terminal, or prints one line per minute; prints messages there.
pub struct TerminalProgress {
    bar: Mutex<Option<TaskBar>>,
    lines: Mutex<ProgressLines>,
    /// Start of its clock.
    start: Instant,
}

impl Default for TerminalProgress {
    fn default() -> Self {
        Self { bar: Mutex::default(), lines: Mutex::default(), start: Instant::now() }
    }
}

impl Console for TerminalProgress {
    fn print(&self, text: &str) {
        print(text);
    }

    fn print_json(&self, document: &str) {
        print_json(document);
    }

    fn print_message(&self, line: &str) {
        print_message(line);
    }

    fn is_terminal(&self) -> bool {
        std::io::stdout().is_terminal()
    }

    fn observer(&self) -> &dyn Observer {
        self
    }
}

struct TaskBar {
    total: usize,
    bar: ProgressBar,
}

impl TaskBar {
    fn new(progress: Progress<'_>) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let unit = unit(progress.unit);
        let style =
            ProgressStyle::with_template(&format!("{{prefix}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left"));
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { total: progress.total, bar }
    }
}

fn unit(unit: ProgressUnit) -> &'static str {
    match unit {
        ProgressUnit::Tiles => "tiles",
        ProgressUnit::Images => "images",
        ProgressUnit::Pilots => "pilots",
    }
}

/// Heading of the current work: "left, frame 12 (3/20)".
fn heading(progress: Progress<'_>) -> String {
    let heading = terminal_text(progress.heading);
    match progress.frame {
        None => heading.into_owned(),
        Some(frame) => format!("{heading}, frame {} ({}/{})", frame.number, frame.place, frame.count),
    }
}

/// Interval between lines of progress where stderr is no terminal, s.
const LINE_INTERVAL_S: f64 = 60.0;

/// Schedule of lines of progress.
#[derive(Default)]
struct ProgressLines {
    /// Total of the task, and its start.
    task: Option<(usize, f64)>,
    last_s: f64,
}

impl ProgressLines {
    /// Returns the line of this progress, if one is due.
    fn due(&mut self, progress: Progress<'_>, now_s: f64) -> Option<String> {
        let (total, began_s) =
            self.task.filter(|(total, _)| *total == progress.total).unwrap_or((progress.total, now_s));
        self.task = (progress.done < progress.total).then_some((total, began_s));
        if now_s - self.last_s < LINE_INTERVAL_S || progress.total == 0 {
            return None;
        }
        self.last_s = now_s;
        let fraction = progress.done as f64 / progress.total as f64;
        let left = match progress.done {
            0 => String::new(),
            _ => format!(", about {:.0} s left", (now_s - began_s) * (1.0 - fraction) / fraction),
        };
        Some(format!(
            "{}: {:.0} % ({} of {} {}) after {now_s:.0} s{left}\n",
            heading(progress),
            100.0 * fraction,
            progress.done,
            progress.total,
            unit(progress.unit)
        ))
    }
}

impl Observer for TerminalProgress {
    fn now_s(&self) -> Option<f64> {
        Some(self.start.elapsed().as_secs_f64())
    }

    fn message(&self, message: Message<'_>) {
        match message {
            Message::Note(text) => print_message(&format!("note: {text}\n")),
            Message::Warning(text) => print_message(&format!("warning: {text}\n")),
        }
    }

    fn progress(&self, progress: Progress<'_>) {
        if !std::io::stderr().is_terminal() {
            let now_s = self.start.elapsed().as_secs_f64();
            let line = self.lines.lock().unwrap_or_else(std::sync::PoisonError::into_inner).due(progress, now_s);
            line.iter().for_each(|line| print_message(line));
            return;
        }
        // A thread that panicked while drawing leaves no inconsistent state here.
        let mut task = self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if task.as_ref().is_some_and(|task| task.total != progress.total) {
            task.take().iter().for_each(|task| task.bar.finish_and_clear());
        }
        let bar = task.get_or_insert_with(|| TaskBar::new(progress));
        bar.bar.set_length(progress.total as u64);
        bar.bar.set_prefix(heading(progress));
        bar.bar.set_position(progress.done as u64);
        if progress.done == progress.total {
            task.take().iter().for_each(|task| task.bar.finish_and_clear());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use etendue::FramePlace;

    #[test]
    fn a_frame_is_reported_with_its_place_in_the_run() {
        let frame = Some(FramePlace { number: 12, place: 3, count: 20 });
        let progress = Progress { heading: "left", frame, unit: ProgressUnit::Tiles, done: 5, total: 100 };
        assert_eq!(heading(progress), "left, frame 12 (3/20)");
        assert_eq!(heading(Progress { frame: None, ..progress }), "left");
    }

    #[test]
    fn without_a_terminal_there_is_a_line_a_minute() {
        let mut lines = ProgressLines::default();
        let progress = |done| Progress { heading: "left", frame: None, unit: ProgressUnit::Tiles, done, total: 200 };
        let printed: Vec<String> = (0..=200).filter_map(|done| lines.due(progress(done), done as f64)).collect();
        let expected = [
            "left: 30 % (60 of 200 tiles) after 60 s, about 140 s left\n",
            "left: 60 % (120 of 200 tiles) after 120 s, about 80 s left\n",
            "left: 90 % (180 of 200 tiles) after 180 s, about 20 s left\n",
        ];
        assert_eq!(printed, expected);
        // The next task has a clock of its own.
        assert_eq!(lines.due(progress(0), 230.0), None);
        assert_eq!(
            lines.due(progress(100), 250.0).as_deref(),
            Some("left: 50 % (100 of 200 tiles) after 250 s, about 20 s left\n")
        );
    }
}
