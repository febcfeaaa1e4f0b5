//! The job: which scene, seen by which cameras, rendered how, written where.

use serde_json::{Value as Json, json};

use super::camera::Camera;
use super::output::Output;
use super::pose::Pose;
use super::render::Render;
use super::scene::Scene;
use super::sequence::Sequence;
use crate::document::Node;
use crate::fault::{ErrorCode, Faults};
use crate::place::Placed;
use crate::reader::{Form, Key, Kind, Reader, Record, Rule, file_name, list, number, path, record};
use crate::written::{Item, Table};

record! {
    /// Which scene, seen by which cameras, rendered how.
    pub struct Job {
        /// The scene: the path of a scene file, or the scene itself as a table.
        required scene: Scene = file_or_table::<Scene>();
        /// The cameras, one or more.
        required cameras: Vec<CameraEntry> = list(record(), 1);
        /// When frames are taken. Default: frame 0 at 0 s.
        optional sequence: Sequence = record();
        /// How the light is found. Default: that of each key.
        optional render: Render = record();
        /// What is written. Default: that of each key.
        optional output: Output = record();
    }
}

record! {
    /// A camera of a job.
    pub struct CameraEntry {
        /// The name, which becomes part of file names: 100 characters at most, and no device of any system, such as CON.
        required name: Placed<String> = file_name("the name of the camera");
        /// The camera.
        inside camera: CameraSource;
        /// Where it stands and looks.
        inside pose: Pose;
        /// How much later than the sequence says its frames begin, s; below 0 earlier. Default: 0.
        optional trigger_offset_s: Placed<f64> = number("s");
        /// Greatest deviation of a frame's beginning, s, 0 or more: each is moved by a random time, evenly spread over ± this.
        /// Default: 0.
        optional trigger_jitter_s: Placed<f64> = number("s").at_least(0.0);
        /// What this camera renders otherwise than the job says.
        optional render: Render = record();
        /// What this camera writes otherwise than the job says.
        optional output: Output = record();
    }
}

/// A camera: its own file, or its tables in the entry.
#[derive(Clone, Debug)]
pub struct CameraSource(pub Camera);

impl Record for CameraSource {
    fn read_keys(reader: &mut Reader<'_>, faults: &mut Faults) -> Option<Self> {
        if reader.given("file").is_none() {
            return Camera::read_keys(reader, faults).map(Self);
        }
        for key in Camera::keys() {
            if let Some(place) = reader.given(key) {
                reader.take(key);
                faults.add(
                    ErrorCode::Contradiction,
                    place,
                    format!("\"{key}\" contradicts \"file\""),
                    "keep the file, or the tables in its place",
                );
            }
        }
        reader.required("file", &file_or_table::<Camera>(), faults).map(Self)
    }

    fn forms() -> Vec<Form> {
        let about = "The path of a camera file.";
        let by_file = Form::default().with(Key::new("file", true, about, path(&["toml"]).schema()));
        [vec![by_file], Camera::forms()].concat()
    }

    fn write_keys(&self, table: &mut Table) {
        self.0.write_keys(table);
    }
}

/// A record in a file of its own, or in place. Files are read before records are: what arrives here is a table.
fn file_or_table<T: Record>() -> FileOrTable<T> {
    FileOrTable(std::marker::PhantomData)
}

struct FileOrTable<T>(std::marker::PhantomData<T>);

impl<T: Record> Rule for FileOrTable<T> {
    type Out = T;
    fn takes(&self, kind: Kind) -> bool {
        kind == Kind::Table
    }
    fn expected(&self) -> String {
        "the path of a file (.toml), or a table".to_owned()
    }
    fn schema(&self) -> Json {
        json!({ "anyOf": [path(&["toml"]).schema(), record::<T>().schema()] })
    }
    fn read(&self, node: &Node, faults: &mut Faults) -> Option<T> {
        if node.as_table().is_none() {
            return self.refuse(node, faults);
        }
        record::<T>().read(node, faults)
    }
    fn write(&self, value: &T) -> Option<Item> {
        record().write(value)
    }
}
