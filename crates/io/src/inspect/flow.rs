//! Inspection of files of optical flow and float maps: `.flo`, KITTI's PNG, PFM.

use std::path::Path;

use etendue_core::{Plane, quantity::OpticalFlow};

use super::{FileReport, Preview, drawing::draw_flow, layer, report::ChannelReport};
use crate::correspondence::{decode_flo, decode_kitti_flow};
use crate::{Error, photograph::decode_photograph};

pub(super) fn middlebury(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    Ok(flow_report(file, "optical flow, Middlebury .flo", "float", &decode_flo(file, bytes)?))
}

pub(super) fn kitti(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    Ok(flow_report(file, "optical flow, KITTI 2015 PNG", "16 bit", &decode_kitti_flow(file, bytes)?))
}

fn flow_report(file: &Path, kind: &str, stored_as: &str, flow: &Plane<OpticalFlow>) -> FileReport {
    let mut report = FileReport::new(file, kind);
    let (width, height) = (flow.width(), flow.height());
    report.state("size", format!("{width} x {height} pixels"));
    let [u, v] = [0, 1].map(|axis| flow.samples().iter().map(|vector| vector[axis]).collect::<Vec<f32>>());
    for (name, values) in [("u (px, right)", &u), ("v (px, down)", &v)] {
        report.channels.push(ChannelReport::new(name, stored_as, values.iter().map(|px| f64::from(*px))));
    }
    let (rgb, scale) = draw_flow(&u, &v);
    report.preview = Some(Preview { width, height, rgb });
    report.notes.push(layer::wheel_note("the flow", scale, " px"));
    report
}

/// PFM: disparities or depths if it has one channel, a linear image if it has three.
pub(super) fn float_map(file: &Path, bytes: &[u8]) -> Result<FileReport, Error> {
    let map = decode_photograph(file, bytes)?;
    let mut report = FileReport::new(file, "float map, PFM");
    report.state("size", format!("{} x {} pixels", map.width, map.height));
    for channel in &map.channels {
        let values = channel.samples.iter().map(|v| f64::from(*v));
        report.channels.push(ChannelReport::new(&channel.name, "float", values));
    }
    let preview = match &map.channels[..] {
        [r, g, b] => {
            let pixels = r.samples.iter().zip(&g.samples).zip(&b.samples).map(|((r, g), b)| [*r, *g, *b]);
            Preview::from_linear(map.width, map.height, &pixels.collect::<Vec<_>>())
        }
        channels => {
            let (preview, note) = layer::differences(map.width, map.height, &channels[0].samples);
            report.notes.push(note);
            preview
        }
    };
    report.preview = Some(preview);
    Ok(report)
}

#[cfg(test)]
mod tests {
    use crate::correspondence::tests_support::flow;
    use crate::correspondence::{encode_flo, encode_kitti_flow, encode_pfm};
    use crate::inspect::inspect;
    use std::fs;

    #[test]
    fn flow_and_disparity_are_reported_and_drawn() {
        let folder = tempfile::tempdir().expect("temporary folder");
        let vectors = flow(2, &[[2.0, 0.0], [0.0, 2.0], [f32::NAN, 0.0], [0.0, 0.0]]);
        let files = [
            ("a.flo", encode_flo(&vectors), "optical flow, Middlebury .flo"),
            ("a.png", encode_kitti_flow(&vectors), "optical flow, KITTI 2015 PNG"),
        ];
        for (name, bytes, kind) in files {
            let path = folder.path().join(name);
            fs::write(&path, bytes.expect("four pixels")).expect("write");
            let report = inspect(&path).expect("flow");
            assert_eq!(report.kind, kind);
            assert_eq!((report.channels[0].max, report.channels[1].nan_count), (Some(2.0), 1));
            assert_eq!(report.preview.expect("drawn").rgb, [[255, 0, 0], [255, 229, 0], [0; 3], [255; 3]]);
            assert!(report.notes[0].contains("full saturation at 2.0000 px"), "{:?}", report.notes);
        }
        let path = folder.path().join("d.pfm");
        fs::write(&path, encode_pfm(2, &[1.0, 3.0, f32::NAN, 3.0]).expect("four pixels")).expect("write");
        let report = inspect(&path).expect("a float map");
        assert_eq!((report.kind.as_str(), report.channels[0].infinite_count), ("float map, PFM", 1));
        assert_eq!(report.preview.expect("drawn").rgb[2], [255; 3]);
    }
}
