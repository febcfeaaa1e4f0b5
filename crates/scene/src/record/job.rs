//! The job: scene, cameras, render settings and outputs.

use serde_json::{Value as Json, json};

use super::camera::Camera;
use super::output::Output;
use super::pose::Pose;
use super::render::Render;
use super::scene::Scene;
use super::sequence::Sequence;
use crate::document::Node;
use crate::fault::{DescriptionErrors, ErrorCode};
use crate::place::Placed;
use crate::reader::{Form, Key, Reader, Record, Rule, ValueKind, file_name, list, number, path, record};
use crate::written::{Item, Table};

record! {
    /// A job: scene, cameras, render settings and outputs.
    pub struct Job {
        /// Scene: a file, or the scene itself.
        required scene: Scene = file_or_table::<Scene>();
        /// The cameras, one or more.
        required cameras: Vec<CameraEntry> = list(record(), 1);
        /// Times of the frames. Default: frame 0 at 0 s.
        optional sequence: Sequence = record();
        /// Light transport and sampling.
        optional render: Render = record();
        /// Files that are written.
        optional output: Output = record();
    }
}

record! {
    /// A camera of a job.
    pub struct CameraEntry {
        /// Name, part of file names: at most 100 characters, no device name such as CON.
        required name: Placed<String> = file_name("the name of the camera");
        /// The camera.
        inside camera: CameraSource;
        /// Pose.
        inside pose: Pose;
        /// Delay of its frames relative to the sequence. Default: 0.
        optional trigger_offset_s: Placed<f64> = number("s");
        /// Trigger jitter: each start is shifted uniformly within ± this. Default: 0.
        optional trigger_jitter_s: Placed<f64> = number("s").at_least(0.0);
        /// Render settings that differ from the job's.
        optional render: Render = record();
        /// Outputs that differ from the job's.
        optional output: Output = record();
    }
}

/// A camera: its own file, or its tables in the entry.
#[derive(Clone, Debug)]
pub struct CameraSource(pub Camera);

impl Record for CameraSource {
    fn read_keys(reader: &mut Reader<'_>, errors: &mut DescriptionErrors) -> Option<Self> {
        if reader.place_of("file").is_none() {
            return Camera::read_keys(reader, errors).map(Self);
        }
        for key in Camera::keys() {
            if let Some(place) = reader.place_of(key) {
                reader.take(key);
                errors.add(
                    ErrorCode::Contradiction,
                    place,
                    format!("\"{key}\" contradicts \"file\""),
                    "keep the file, or the tables instead",
                );
            }
        }
        reader.required("file", &file_or_table::<Camera>(), errors).map(Self)
    }

    fn forms() -> Vec<Form> {
        let description = "The path of a camera file.";
        let by_file = Form::default().with(Key::new("file", true, description, path(&["toml"]).schema()));
        [vec![by_file], Camera::forms()].concat()
    }

    fn write_keys(&self, table: &mut Table) {
        self.0.write_keys(table);
    }
}

/// A record in a file of its own, or inline. Files are read before records, so a table arrives here.
fn file_or_table<T: Record>() -> FileOrTable<T> {
    FileOrTable(std::marker::PhantomData)
}

struct FileOrTable<T>(std::marker::PhantomData<T>);

impl<T: Record> Rule for FileOrTable<T> {
    type Out = T;
    fn accepts(&self, kind: ValueKind) -> bool {
        kind == ValueKind::Table
    }
    fn expected(&self) -> String {
        "the path of a file (.toml), or a table".to_owned()
    }
    fn schema(&self) -> Json {
        json!({ "anyOf": [path(&["toml"]).schema(), record::<T>().schema()] })
    }
    fn read(&self, node: &Node, errors: &mut DescriptionErrors) -> Option<T> {
        if node.as_table().is_none() {
            return self.refuse(node, errors);
        }
        record::<T>().read(node, errors)
    }
    fn write(&self, value: &T) -> Option<Item> {
        record().write(value)
    }
}
