//! Light in a viewer: the data received by tev's protocol equals the written one, and a viewer changes nothing.

use crate::support::{assert_same, contents, etendue, small, text};
use etendue_io::exr::read_exr;
use std::collections::BTreeMap;
use std::io::Read as _;
use std::net::{TcpListener, TcpStream};
use std::thread;

/// Content of a viewer: the values of each channel, row by row.
#[derive(Debug, Default, PartialEq)]
struct ViewerContent {
    size: [usize; 2],
    channels: BTreeMap<String, Vec<f32>>,
}

/// The fields of a packet.
struct PacketFields<'a>(&'a [u8]);

impl PacketFields<'_> {
    fn bytes<const N: usize>(&mut self) -> [u8; N] {
        let (first, rest) = self.0.split_first_chunk().expect("a field");
        self.0 = rest;
        *first
    }

    fn integer(&mut self) -> usize {
        i32::from_le_bytes(self.bytes()).try_into().expect("no negative number")
    }

    fn text(&mut self) -> String {
        let end = self.0.iter().position(|byte| *byte == 0).expect("an end");
        let text = String::from_utf8(self.0[..end].to_vec()).expect("UTF-8");
        self.0 = &self.0[end + 1..];
        text
    }

    fn texts(&mut self) -> Vec<String> {
        (0..self.integer()).map(|_| self.text()).collect()
    }
}

/// Reads the packets of one connection to its end.
fn view(mut stream: TcpStream) -> BTreeMap<String, ViewerContent> {
    let mut images: BTreeMap<String, ViewerContent> = BTreeMap::new();
    let mut length = [0; 4];
    while stream.read_exact(&mut length).is_ok() {
        let mut packet = vec![0; u32::from_le_bytes(length) as usize - 4];
        stream.read_exact(&mut packet).expect("a whole packet");
        let mut fields = PacketFields(&packet);
        let ([kind, _], name) = (fields.bytes(), fields.text());
        match kind {
            4 => {
                let size = [fields.integer(), fields.integer()];
                let channels = fields.texts().into_iter().map(|name| (name, vec![f32::NAN; size[0] * size[1]]));
                let channels = channels.collect();
                assert!(images.insert(name, ViewerContent { size, channels }).is_none(), "made once");
            }
            6 => update(images.get_mut(&name).expect("made before"), &mut fields),
            other => panic!("packet {other}"),
        }
        assert!(fields.0.is_empty(), "nothing is left");
    }
    images
}

/// The third version of the packet: strided channels.
fn update(image: &mut ViewerContent, fields: &mut PacketFields<'_>) {
    let channels = fields.texts();
    let [x, y, width, height] = std::array::from_fn(|_| fields.integer());
    let mut longs = || -> Vec<usize> { channels.iter().map(|_| i64::from_le_bytes(fields.bytes()) as usize).collect() };
    let (offsets, strides) = (longs(), longs());
    let values: Vec<f32> = fields.0.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    fields.0 = &[];
    for ((name, offset), stride) in channels.iter().zip(offsets).zip(strides) {
        let channel = image.channels.get_mut(name).expect("a channel of the image");
        for place in 0..width * height {
            channel[(y + place / width) * image.size[0] + x + place % width] = values[offset + place * stride];
        }
    }
}

/// Renders while `viewer` handles the connection.
fn render_to_viewer<T: Send + 'static>(
    options: &[&str],
    viewer: impl FnOnce(TcpStream) -> T + Send + 'static,
) -> (BTreeMap<String, Vec<u8>>, String, T) {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let address = listener.local_addr().expect("an address").to_string();
    let viewer = thread::spawn(move || viewer(listener.accept().expect("a call").0));
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let arguments = ["render", &small(), "-o", &text(&out), "--display", &address];
    let run = etendue(arguments.into_iter().chain(options.iter().copied())).ok();
    (contents(&out), run.err, viewer.join().expect("the viewer"))
}

fn render_without_viewer(options: &[&str]) -> BTreeMap<String, Vec<u8>> {
    crate::support::rendered(&small(), options)
}

#[test]
fn a_viewer_shows_the_colours_of_the_written_radiance() {
    for options in [&["--spp", "4"][..], &["--progressive", "--spp", "24"]] {
        let (files, _, images) = render_to_viewer(options, view);
        assert_same(&render_without_viewer(options), &files, "with a viewer");
        let place = tempfile::tempdir().expect("a temporary folder");
        let file = place.path().join("radiance.exr");
        std::fs::write(&file, &files["front/radiance.exr"]).expect("write");
        let written = read_exr(&file).expect("an EXR");
        let image = &images["front"];
        assert_eq!(image.size, [written.width, written.height]);
        for name in ["R", "G", "B"] {
            let preview = written.channel(name).expect("a preview").to_floats();
            assert_eq!(image.channels[name], preview.to_vec(), "{name}");
        }
    }
}

#[test]
fn electrons_that_pixels_make_are_shown_as_such() {
    let off = ["--set", "output.radiance=false", "--set", "output.irradiance=false"];
    let options = [&["--spp", "4"][..], &off].concat();
    let (files, _, images) = render_to_viewer(&options, view);
    let image = &images["front"];
    assert_eq!(image.channels.keys().collect::<Vec<_>>(), ["Y"]);
    assert!(image.channels["Y"].iter().all(|electrons| electrons.is_finite()));
    assert!(files.contains_key("front/electrons.exr"));
}

#[test]
fn a_lost_viewer_is_reported_and_the_run_continues() {
    let (files, messages, ()) = render_to_viewer(&["--spp", "4"], drop);
    assert_same(&render_without_viewer(&["--spp", "4"]), &files, "without its viewer");
    assert!(messages.lines().filter(|line| line.contains("the viewer at 127.0.0.1")).count() <= 1, "{messages}");
}

/// The viewer accepts, and reads nothing before the run is over: its buffers may hold everything, or the connection is closed after 5 s.
#[test]
fn a_viewer_that_does_not_read_changes_nothing() {
    let (files, _, _stream) = render_to_viewer(&["--spp", "4"], |stream| stream);
    assert_same(&render_without_viewer(&["--spp", "4"]), &files, "with a viewer that waits");
}

#[test]
fn a_viewer_that_is_not_there_is_an_error_before_anything_is_rendered() {
    let place = tempfile::tempdir().expect("a temporary folder");
    let out = place.path().join("out");
    let free = TcpListener::bind("127.0.0.1:0").and_then(|listener| listener.local_addr()).expect("a port");
    for address in [free.to_string().as_str(), "127.0.0.1", "nowhere.invalid:1"] {
        let run = etendue(["render", &small(), "-o", &text(&out), "--display", address]);
        run.refused(&["--display", address, "start the viewer"]);
        assert!(!out.exists());
    }
}
