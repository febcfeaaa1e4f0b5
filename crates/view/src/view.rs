//! From the folders of results to a page.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use etendue::{Error, ErrorCode, ExistingFiles, Message, Observer, Progress, ProgressUnit};
use etendue_io::inspect::{ChannelReport, VIRIDIS, flow_wheel};
use serde_json::{Map, Value, json};

use crate::layer::{Layer, NamedPlane, Role, Samples};
use crate::pack::{self, packed};
use crate::page::{Page, is_ours};
use crate::pairs::{FilePair, paired};
use crate::read::{self, FileLayers, SideCar};
use crate::request::ViewRequest;
use crate::result_files::{ResultFile, find};

/// Writes the page of a result: into the folder `page`, as the single file `page` if that ends in `.html`, or into the folder
/// `view` of the result, where it replaces an earlier page. Returns the file to open. Only one file of each result is in memory
/// at a time.
///
/// # Errors
/// If a folder is not a result, a file of it is damaged, or compared layers differ in size; nothing is written then. If the page
/// cannot be written, or the observer cancels.
pub fn view(
    request: &ViewRequest,
    page: Option<&Path>,
    existing: ExistingFiles,
    observer: &dyn Observer,
) -> Result<PathBuf, Error> {
    if request.max_mb == 0 {
        return Err(Error::argument("max_mb", "`max_mb` 0: expected 1 or more").with_code(ErrorCode::OutOfRange));
    }
    let frames = request.frames.as_ref();
    let first = find(&request.folder, frames)?;
    let second = request.beside.as_ref().map(|folder| find(folder, frames)).transpose()?;
    let has_two = second.is_some();
    let pairs = paired(first, second.unwrap_or_default());
    if has_two && !pairs.iter().any(|pair| pair.files.iter().all(Option::is_some)) {
        let second_folder = request.beside.as_deref().unwrap_or(Path::new("")).display();
        return Err(Error::coded(
            ErrorCode::NotComparable,
            format!(
                "{second_folder}: no file has the same camera, frame and name as one in {}; give results of the same cameras and frames",
                request.folder.display()
            ),
        ));
    }
    let own = request.folder.join("view");
    let (path, existing) = match page {
        Some(page) => (page, existing),
        None if is_ours(&own) => (own.as_path(), ExistingFiles::Replace),
        None => (own.as_path(), existing),
    };
    let mut build =
        ViewBuilder { request, page: Page::open(path, existing)?, layers: Vec::new(), files: Vec::new(), binned: 0 };
    for (done, pair) in pairs.iter().enumerate() {
        if observer.cancelled() {
            return Err(Error::run("cancelled; nothing was written"));
        }
        observer.progress(Progress {
            heading: "view",
            frame: None,
            unit: ProgressUnit::Images,
            done,
            total: pairs.len(),
        });
        build.pair(pair)?;
    }
    observer.progress(Progress {
        heading: "view",
        frame: None,
        unit: ProgressUnit::Images,
        done: pairs.len(),
        total: pairs.len(),
    });
    if build.binned > 0 {
        let sentence = format!(
            "{} layers are larger than {} MB and have fewer pixels on the page, which states the factor; `max_mb` sets this limit",
            build.binned, request.max_mb
        );
        observer.message(Message::Note(&sentence));
    }
    build.finish()
}

struct ViewBuilder<'a> {
    request: &'a ViewRequest,
    page: Page,
    layers: Vec<Value>,
    files: Vec<BTreeMap<String, String>>,
    /// Layers with fewer pixels than their file.
    binned: usize,
}

impl ViewBuilder<'_> {
    fn pair(&mut self, pair: &FilePair) -> Result<(), Error> {
        let read = |file: &ResultFile| {
            let side_car = SideCar::read(file.path.parent().unwrap_or(Path::new("")))?;
            read::layers(file, &side_car)
        };
        let mut both = Vec::new();
        for (result, file) in pair.files.iter().enumerate() {
            let Some(file) = file else { continue };
            both.push((result, file, read(file)?));
        }
        if let [(_, a, layers_a), (_, b, layers_b)] = &both[..] {
            same_sizes((a, &layers_a.layers), (b, &layers_b.layers))?;
        }
        let steps = self.steps(&both);
        for (result, file, read) in both {
            let facts = self.files.len();
            self.files.push(read.facts);
            for layer in read.layers {
                let step = steps.get(&layer.name).copied().unwrap_or(1);
                self.layer(LayerPosition { result, place: &pair.place, file, facts }, &layer, step)?;
            }
        }
        Ok(())
    }

    /// Downsampling factors of layers: equal in both results.
    fn steps(&self, both: &[(usize, &ResultFile, FileLayers)]) -> BTreeMap<String, usize> {
        let mut steps = BTreeMap::new();
        for layer in both.iter().flat_map(|(_, _, read)| &read.layers) {
            let step = pack::factor(layer, self.request.max_mb as usize * 1_000_000);
            let max_step = steps.entry(layer.name.clone()).or_insert(1);
            *max_step = step.max(*max_step);
        }
        steps
    }

    fn layer(&mut self, position: LayerPosition<'_>, layer: &Layer, step: usize) -> Result<(), Error> {
        self.binned += usize::from(step > 1);
        let planes = pack::planes(layer, step);
        let packed = packed(&planes)?;
        let chunk = (!planes.is_empty()).then(|| format!("{:04}", self.layers.len()));
        if let Some(id) = &chunk {
            self.page.add(id, &packed.text)?;
        }
        self.layers.push(position.json(layer, step, &packed, chunk));
        Ok(())
    }

    fn finish(self) -> Result<PathBuf, Error> {
        let names = names(&self.request.folder, self.request.beside.as_deref());
        let title = names.join(" with ");
        let facts = json!({
            "version": env!("CARGO_PKG_VERSION"),
            "title": title,
            "results": names,
            "viridis": VIRIDIS,
            "wheel": flow_wheel(),
            "files": self.files,
            "layers": self.layers,
        });
        self.page.finish(&title, &facts)
    }
}

/// Position of a layer on the page.
struct LayerPosition<'a> {
    result: usize,
    place: &'a str,
    file: &'a ResultFile,
    facts: usize,
}

impl LayerPosition<'_> {
    fn json(&self, layer: &Layer, step: usize, packed: &pack::EncodedPlanes, chunk: Option<String>) -> Value {
        let ResultFile { name: file, stem, frame, .. } = self.file;
        // The same layer in all frames, and in both results.
        let ending = file.rsplit_once('.').map_or("", |(_, ending)| ending);
        let (width, height) = pack::size(layer, step);
        let planes = layer.planes.iter().zip(&packed.types);
        let layer_json = json!({
            "result": self.result,
            "place": self.place,
            "frame": frame,
            "file": file,
            "group": stem,
            "key": format!("{stem}.{ending}/{}", layer.name),
            "name": layer.name,
            "unit": layer.unit,
            "meaning": layer.meaning,
            "columns": layer.size.0,
            "rows": layer.size.1,
            "width": width,
            "height": height,
            "step": step,
            "has_means": layer.has_means(),
            "planes": planes.map(|(plane, encoding_and_scale)| plane_json(plane, *encoding_and_scale)).collect::<Vec<_>>(),
            "chunk": chunk,
            "facts": self.facts,
        });
        let Value::Object(mut layer_json) = layer_json else { return Value::Null };
        layer_json.extend(layer.kind.to_json(step > 1));
        Value::Object(layer_json)
    }
}

/// A plane: its encoding, and the statistics of all its numbers in the file.
fn plane_json(plane: &NamedPlane, (stored, scale): (&'static str, f64)) -> Map<String, Value> {
    let channel_report = ChannelReport::new(&plane.name, stored, plane.samples.numbers());
    let mut object = json!({ "name": plane.name, "type": stored });
    if plane.role == Role::Error {
        object["is_error"] = json!(true);
    } else if !matches!(plane.samples, Samples::Integers(_)) || channel_report.max.is_some() {
        for (key, value) in [("min", channel_report.min), ("mean", channel_report.mean), ("max", channel_report.max)] {
            object[key] = json!(value);
        }
        object["nan"] = json!(channel_report.nan_count);
        object["infinite"] = json!(channel_report.infinite_count);
    }
    if stored == "f16" {
        object["scale"] = json!(scale);
    }
    let Value::Object(object) = object else { return Map::new() };
    object
}

/// Checks that compared layers have the same size.
fn same_sizes((a, layers_a): (&ResultFile, &[Layer]), (b, layers_b): (&ResultFile, &[Layer])) -> Result<(), Error> {
    for layer in layers_b {
        let Some(other) = layers_a.iter().find(|other| other.name == layer.name) else { continue };
        if other.size != layer.size {
            let ([w, h], [other_width, other_height]) =
                (<[usize; 2]>::from(layer.size), <[usize; 2]>::from(other.size));
            return Err(Error::coded(
                ErrorCode::NotComparable,
                format!(
                    "{}: {} is {w} × {h} pixels, but that of {} is {other_width} × {other_height}; give results of the same size",
                    b.path.display(),
                    layer.name,
                    a.path.display()
                ),
            ));
        }
    }
    Ok(())
}

/// The names of the results: the last parts of their paths in which they differ.
fn names(folder: &Path, second: Option<&Path>) -> Vec<String> {
    let parts = |path: &Path| -> Vec<String> {
        let absolute = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
        absolute.components().map(|part| part.as_os_str().to_string_lossy().into_owned()).collect()
    };
    let all: Vec<Vec<String>> = [Some(folder), second].into_iter().flatten().map(parts).collect();
    let tail = |parts: &Vec<String>, count: usize| parts[parts.len().saturating_sub(count)..].join("/");
    let longest = all.iter().map(Vec::len).max().unwrap_or(1);
    let differ = |count: &usize| all.len() < 2 || tail(&all[0], *count) != tail(&all[1], *count);
    let count = (1..=longest).find(differ).unwrap_or(1);
    all.iter().map(|parts| tail(parts, count)).collect()
}
