//! Long tasks on a separate thread, watched by the calling one.

use crate::error::exception;
use etendue::{Error, Message, Observer, Progress, terminal_text};
use etendue_cli::{Console, pool};
use pyo3::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Maximum and initial pause of the calling thread between checks: short tasks are not delayed.
const PAUSE: Duration = Duration::from_millis(10);
const FIRST_PAUSE: Duration = Duration::from_micros(100);

/// Message after a panic, which the panic's own lines on stderr explain.
const PANIC_MESSAGE: &str = "an internal error ended this run, at the place stated on stderr; files with their final names are complete. Please report those lines";

/// Messages of the task that the calling thread passes on.
pub(crate) struct Watch {
    start: Instant,
    cancelled: AtomicBool,
    pending: Mutex<PendingMessages>,
}

#[derive(Default)]
struct PendingMessages {
    /// Only the latest progress.
    progress: Option<(String, usize, usize)>,
    /// Messages; true for a warning.
    messages: Vec<(bool, String)>,
    /// Result of a verb.
    result: String,
}

impl Observer for Watch {
    fn message(&self, message: Message<'_>) {
        let line = match message {
            Message::Note(text) => (false, text.to_owned()),
            Message::Warning(text) => (true, text.to_owned()),
        };
        self.take_pending().messages.push(line);
    }

    fn progress(&self, progress: Progress<'_>) {
        let heading = match progress.frame {
            None => progress.heading.to_owned(),
            Some(frame) => format!("{}, frame {} ({}/{})", progress.heading, frame.number, frame.place, frame.count),
        };
        self.take_pending().progress = Some((heading, progress.done, progress.total));
    }

    fn now_s(&self) -> Option<f64> {
        Some(self.start.elapsed().as_secs_f64())
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl Console for Watch {
    fn print(&self, text: &str) {
        self.take_pending().result.push_str(text);
    }

    fn print_message(&self, line: &str) {
        self.message(Message::Note(line.trim_end()));
    }

    fn observer(&self) -> &dyn Observer {
        self
    }
}

impl Watch {
    fn new() -> Self {
        Self { start: Instant::now(), cancelled: AtomicBool::new(false), pending: Mutex::default() }
    }

    fn take_pending(&self) -> MutexGuard<'_, PendingMessages> {
        self.pending.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Result of a verb.
    pub(crate) fn set_result(&self) -> String {
        std::mem::take(&mut self.take_pending().result)
    }

    /// Passes on what was received: progress to the caller's function, warnings to `warnings`, notes to `logging`.
    fn forward_messages(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        py.check_signals()?;
        let (latest, messages) = {
            let mut pending = self.take_pending();
            (pending.progress.take(), std::mem::take(&mut pending.messages))
        };
        if let (Some(progress), Some(latest)) = (progress, latest) {
            progress.call1(py, latest)?;
        }
        for (is_warning, text) in messages {
            let text = terminal_text(&text);
            match is_warning {
                true => py.import("warnings")?.call_method1("warn", (text,))?,
                false => {
                    py.import("logging")?.call_method1("getLogger", ("etendue",))?.call_method1("info", (text,))?
                }
            };
        }
        Ok(())
    }
}

/// Runs `work` on a pool of `threads` (`None`: one per processor) with Python's lock released. `progress` is called in the calling thread with the current
/// step, the amount done, and the total. An exception from a signal or from that function cancels the work and is raised instead.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    threads: Option<u32>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Watch) -> Result<T, Error> + Send,
) -> PyResult<T> {
    let watch = Watch::new();
    let pool = pool(threads).map_err(|error| exception(py, error))?;
    let (done, raised) = py.detach(|| {
        std::thread::scope(|scope| {
            let task = scope.spawn(|| pool.install(|| work(&watch)));
            let (mut raised, mut pause) = (None, FIRST_PAUSE);
            loop {
                let is_done = task.is_finished();
                // A function that has raised is not called again.
                let progress = progress.filter(|_| raised.is_none());
                if let Err(error) = Python::attach(|py| watch.forward_messages(py, progress)) {
                    watch.cancelled.store(true, Ordering::Relaxed);
                    raised.get_or_insert(error);
                }
                if is_done {
                    return (task.join(), raised);
                }
                std::thread::sleep(pause);
                pause = PAUSE.min(2 * pause);
            }
        })
    });
    match (raised, done) {
        (Some(raised), _) => Err(raised),
        (None, Ok(result)) => result.map_err(|error| exception(py, error)),
        (None, Err(_)) => Err(exception(py, Error::Run(PANIC_MESSAGE.to_owned()))),
    }
}
