//! Shows light in a viewer during rendering, over the network.
//!
//! [`tev`] writes the packets of the protocol; [`Display`] sends them from a thread of its own, so that a slow viewer does not slow down the
//! rendering. Tiles wait in the images themselves: one that is refined before it is sent is sent once. A lost viewer is reported once, and the
//! rendering continues.

mod displaying;
mod images;
mod tev;

use crate::output::print_message;
pub use displaying::DisplayObserver;
use etendue::{Error, ImageTile};
use images::ImageQueue;
use std::io::Write as _;
use std::net::{TcpStream, ToSocketAddrs as _};
use std::sync::mpsc::{self, Receiver};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// Timeout of a viewer's answer to a call, and of its reception of a packet.
const TIMEOUT: Duration = Duration::from_secs(5);

/// A viewer.
pub struct Display {
    address: String,
    shared: Arc<SharedState>,
    /// Closed when everything is sent, or the viewer is lost.
    done: Mutex<Receiver<()>>,
}

#[derive(Default)]
struct SharedState {
    state: Mutex<DisplayState>,
    changed: Condvar,
}

#[derive(Default)]
struct DisplayState {
    images: ImageQueue,
    /// No further tiles will come.
    is_ended: bool,
    /// The viewer is lost.
    is_lost: bool,
}

impl SharedState {
    fn state(&self) -> MutexGuard<'_, DisplayState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the packets of the next tile, and waits for them; `None` at the end.
    fn next(&self) -> Option<Vec<u8>> {
        let mut state = self.state();
        loop {
            if let Some(packets) = state.images.next() {
                return Some(packets);
            }
            if state.is_ended {
                return None;
            }
            state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }
}

impl Display {
    /// Connects to the viewer at HOST:PORT.
    ///
    /// # Errors
    /// No viewer answers.
    pub fn connect(address: &str) -> Result<Self, Error> {
        let connection_error = |why: String| {
            Error::argument(
                "display",
                format!(
                    "`display` {address}: {why}; start the viewer there first (tev listens at 127.0.0.1:14158), or omit this argument"
                ),
            )
        };
        let mut addresses = address.to_socket_addrs().map_err(|cause| connection_error(cause.to_string()))?.peekable();
        let mut why = "no such host".to_owned();
        let stream = addresses.find_map(|address| {
            TcpStream::connect_timeout(&address, TIMEOUT)
                .map_err(|cause| why = format!("no viewer answers ({cause})"))
                .ok()
        });
        let stream = stream.ok_or_else(|| connection_error(why))?;
        let prepared = stream.set_write_timeout(Some(TIMEOUT)).and_then(|()| stream.set_nodelay(true));
        prepared.map_err(|cause| connection_error(cause.to_string()))?;
        let (shared, (done_sender, done)) = (Arc::new(SharedState::default()), mpsc::channel());
        let (sent, display_address) = (Arc::clone(&shared), address.to_owned());
        std::thread::spawn(move || {
            send(stream, &sent, &display_address);
            drop(done_sender);
        });
        Ok(Self { address: address.to_owned(), shared, done: Mutex::new(done) })
    }

    /// Stores a tile to be sent.
    pub fn tile(&self, tile: &ImageTile<'_>) {
        let mut state = self.shared.state();
        if !state.is_lost {
            state.images.store(tile);
            self.shared.changed.notify_one();
        }
    }

    /// Waits for a limited time until everything is sent.
    pub fn finish(self) {
        self.shared.state().is_ended = true;
        self.shared.changed.notify_one();
        let done = self.done.into_inner().unwrap_or_else(PoisonError::into_inner);
        if done.recv_timeout(TIMEOUT) == Err(mpsc::RecvTimeoutError::Timeout) {
            warn(&self.address, "it is slow and did not receive the last tiles");
        }
    }
}

/// Sends tiles until there are no more, or the viewer is lost.
fn send(mut stream: TcpStream, shared: &SharedState, address: &str) {
    while let Some(packets) = shared.next() {
        if let Err(cause) = stream.write_all(&packets) {
            let mut state = shared.state();
            (state.is_lost, state.images) = (true, ImageQueue::default());
            drop(state);
            return warn(address, &format!("it no longer accepts tiles ({cause}); rendering continues"));
        }
    }
}

fn warn(address: &str, what: &str) {
    print_message(&format!("warning: the viewer at {address}: {what}\n"));
}
