//! Progress on a terminal, and messages while a task runs. Ctrl-C stops by the operating system's own way.

use crate::console::Console;
use crate::output::{print, print_json, print_message};
use etendue::{Message, Observer, Progress, Unit, terminal_text};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::Mutex;
use std::time::Instant;

/// Draws a bar of each task on stderr where that is a terminal, and prints messages there.
pub struct Terminal {
    bar: Mutex<Option<Bar>>,
    /// What its clock counts from.
    start: Instant,
}

impl Default for Terminal {
    fn default() -> Self {
        Self { bar: Mutex::default(), start: Instant::now() }
    }
}

impl Console for Terminal {
    fn print(&self, text: &str) {
        print(text);
    }

    fn print_json(&self, document: &str) {
        print_json(document);
    }

    fn tell(&self, line: &str) {
        print_message(line);
    }

    fn is_terminal(&self) -> bool {
        std::io::stdout().is_terminal()
    }

    fn observer(&self) -> &dyn Observer {
        self
    }
}

struct Bar {
    total: usize,
    bar: ProgressBar,
}

impl Bar {
    fn new(progress: Progress<'_>) -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
        let unit = match progress.unit {
            Unit::Tiles => "tiles",
            Unit::Pictures => "pictures",
            Unit::Pilots => "ways",
        };
        let style =
            ProgressStyle::with_template(&format!("{{prefix}} {{wide_bar}} {{pos}}/{{len}} {unit}, {{eta}} left"));
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()));
        Self { total: progress.total, bar }
    }
}

/// What is worked on: "left, frame 12 (3/20)".
fn heading(progress: Progress<'_>) -> String {
    let heading = terminal_text(progress.heading);
    match progress.frame {
        None => heading.into_owned(),
        Some(frame) => format!("{heading}, frame {} ({}/{})", frame.number, frame.place, frame.count),
    }
}

impl Observer for Terminal {
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
        // A thread that panicked while it drew leaves nothing half-done here.
        let mut task = self.bar.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if task.as_ref().is_some_and(|task| task.total != progress.total) {
            task.take().iter().for_each(|task| task.bar.finish_and_clear());
        }
        let drawn = task.get_or_insert_with(|| Bar::new(progress));
        drawn.bar.set_length(progress.total as u64);
        drawn.bar.set_prefix(heading(progress));
        drawn.bar.set_position(progress.done as u64);
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
    fn a_frame_is_told_with_its_place_in_the_run() {
        let frame = Some(FramePlace { number: 12, place: 3, count: 20 });
        let progress = Progress { heading: "left", frame, unit: Unit::Tiles, done: 5, total: 100 };
        assert_eq!(heading(progress), "left, frame 12 (3/20)");
        assert_eq!(heading(Progress { frame: None, ..progress }), "left");
    }
}
