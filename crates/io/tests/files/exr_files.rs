//! EXR files written and read back.

use etendue_testkit::skip::all_here;
use std::fs;
use std::path::{Path, PathBuf};

use etendue_core::quantity::{Identity, Irradiance, Length, MeanElectrons, Quantity, Radiance, Variance, Vector};
use etendue_core::{Bands, Plane, SpectralCube};
use etendue_io::Provenance;
use etendue_io::exr::{
    ExrSamples, GroundTruth, LengthPlanes, SpectralImage, encode_ground_truth, encode_plane, encode_radiance,
    encode_spectral, read_exr, read_spectral,
};
use etendue_io::inspect::{PreviewSelection, inspect, inspect_showing};

const ODD: [f32; 6] = [0.0, -0.0, 1.5e-42, f32::MAX, f32::INFINITY, 1.0 / 3.0];

fn provenance() -> Provenance {
    Provenance {
        plan_hash: "00ff".to_owned(),
        seed: 42,
        version: "0.1.0".to_owned(),
        camera: "front".to_owned(),
        time_s: 0.04,
        geometry: "rectilinear, pixel centres at + 0.5".to_owned(),
        camera_to_world: Some([[0.0, 0.0, 1.0, 2.5], [-1.0, 0.0, 0.0, 0.0], [0.0, -1.0, 0.0, 1.6]]),
        ..Provenance::default()
    }
}

fn cube<Q: Quantity<Sample = f32>>(offset: f32) -> SpectralCube<Q> {
    let bands = Bands::covering(380.0, 780.0, 5.0).expect("80 bands");
    let plane = |i: usize| Plane::from_samples(3, 2, ODD.map(|v| v + offset * i as f32).to_vec()).expect("six pixels");
    SpectralCube::from_planes(bands, (0..bands.count()).map(plane).collect()).expect("one plane per band")
}

fn bits<Q: Quantity<Sample = f32>>(cube: &SpectralCube<Q>) -> Vec<u32> {
    cube.planes().iter().flat_map(Plane::samples).map(|v| v.to_bits()).collect()
}

fn written(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    fs::write(&path, bytes).expect("write");
    path
}

#[test]
fn radiance_and_its_variance_come_back_to_the_bit() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let (values, variance) = (cube::<Radiance>(0.0), cube::<Variance>(0.25));
    let bytes = encode_spectral(&values, Some(&variance), &provenance()).expect("encodable");
    let file = read_spectral(&written(folder.path(), "a.exr", &bytes)).expect("readable");
    let SpectralImage::Radiance(image) = file.image else { panic!("radiance") };
    assert_eq!(image.cube.bands(), values.bands());
    assert_eq!(bits(&image.cube), bits(&values));
    assert_eq!(bits(&image.variance.expect("variance")), bits(&variance));
    assert_eq!(file.provenance, Some(provenance()));
    assert_eq!(file.notes, Vec::<String>::new());
}

#[test]
fn distances_are_stored_with_the_radiance_bit_by_bit() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let values = cube::<Radiance>(0.0);
    let plane =
        |offset: f32| Plane::<Length>::from_samples(3, 2, ODD.map(|v| v + offset).to_vec()).expect("six pixels");
    let (distance, depth) = (plane(1.0), plane(2.0));
    let lengths = LengthPlanes { distance: &distance, depth: &depth };
    let bytes = encode_radiance(&values, None, Some(lengths), &provenance()).expect("encodable");
    let path = written(folder.path(), "a.exr", &bytes);
    let file = read_spectral(&path).expect("readable");
    assert_eq!(file.distance.as_ref(), Some(&distance));
    assert_eq!((file.provenance, file.notes), (Some(provenance()), Vec::new()));
    let SpectralImage::Radiance(image) = file.image else { panic!("radiance") };
    assert_eq!(bits(&image.cube), bits(&values));
    let channels = read_exr(&path).expect("readable").channels;
    let stored = channels.iter().find(|c| c.name == "depth.Z").map(|c| c.samples.to_floats());
    assert_eq!(stored.as_deref(), Some(depth.samples()));
    // Without lengths the bytes are those of any spectral image.
    let plain = encode_radiance(&values, None, None, &provenance()).expect("encodable");
    assert_eq!(plain, encode_spectral(&values, None, &provenance()).expect("encodable"));
}

#[test]
fn irradiance_stays_irradiance() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let bytes = encode_spectral(&cube::<Irradiance>(1.0), None, &provenance()).expect("encodable");
    let path = written(folder.path(), "a.exr", &bytes);
    let SpectralImage::Irradiance(image) = read_spectral(&path).expect("readable").image else { panic!("irradiance") };
    assert_eq!((image.cube, image.variance), (cube(1.0), None));
    let attributes = read_exr(&path).expect("readable").attributes;
    let stated = |name: &str| attributes.get(name).map(String::as_str);
    assert_eq!(stated("etendue:units"), Some("W.m^-2.nm^-1"));
    assert_eq!(stated("emissiveUnits"), Some("W.m^-2"));
    assert_eq!(stated("spectralLayoutVersion"), Some("1.0"));
    assert_eq!(stated("etendue:band_width_nm"), Some("5"));
}

#[test]
fn ground_truth_keeps_its_names_types_and_the_sky() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let depth = Plane::<Length>::from_samples(3, 2, ODD.to_vec()).expect("six pixels");
    let normal = Plane::<Vector>::filled(3, 2, [0.0, 0.6, -0.8]);
    let ids = Plane::<Identity>::from_samples(3, 2, vec![0, 1, 26_003, 16_777_217, 5, u32::MAX]).expect("six pixels");
    let truth = GroundTruth {
        depth: Some(&depth),
        normal: Some(&normal),
        instance: Some(&ids),
        semantic: Some(&ids),
        ..GroundTruth::default()
    };
    let path = written(folder.path(), "a.exr", &encode_ground_truth(&truth, &provenance()).expect("encodable"));
    let exr = read_exr(&path).expect("readable");
    let names: Vec<&str> = exr.channels.iter().map(|c| c.name.as_str()).collect();
    assert_eq!(names, ["N.X", "N.Y", "N.Z", "depth.Z", "instance.ID", "semantic.ID"]);
    assert_eq!(exr.channel("depth.Z"), Some(&ExrSamples::Float(ODD.to_vec())));
    assert_eq!(exr.channel("N.Z"), Some(&ExrSamples::Float(vec![-0.8; 6])));
    assert_eq!(exr.channel("instance.ID"), Some(&ExrSamples::Uint(ids.samples().to_vec())));
    let report = inspect(&path).expect("ground truth");
    assert_eq!(report.kind, "ground truth, EXR");
    assert_eq!(report.channels[3].infinite_count, 1);
    assert!(report.notes[0].starts_with("the image shows depth.Z in the viridis colour map"), "{:?}", report.notes);
    let report_of =
        |layer: &str| inspect_showing(&path, &PreviewSelection { layer: Some(layer.to_owned()), boxes: None });
    let shown = |layer: &str| report_of(layer).expect("a layer").preview.expect("a picture").rgb;
    assert_eq!(shown("instance.ID"), shown("semantic"));
    assert_eq!(shown("instance")[0], [0; 3], "the background");
    assert_eq!(shown("N"), [[128, 204, 26]; 6]);
    let message = report_of("flow").expect_err("none").to_string();
    assert!(message.ends_with("has no layer \"flow\"; expected one of N, depth, instance, semantic"), "{message}");
    let message = inspect(&written(folder.path(), "job.toml", b"format = 1\n")).expect_err("no result").to_string();
    assert!(message.contains("job.toml: a description, neither a result nor an asset"), "{message}");
}

#[test]
fn electrons_say_what_they_are() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let (mean, variance) = (Plane::<MeanElectrons>::filled(4, 3, 250.0), Plane::<Variance>::filled(4, 3, 2.5));
    let bytes = encode_plane(&mean, Some(&variance), &provenance()).expect("encodable");
    let report = inspect(&written(folder.path(), "a.exr", &bytes)).expect("electrons");
    assert!(report.facts.contains(&("units".to_owned(), "e".to_owned())));
    assert_eq!(report.channels[0].name, "electrons");
    assert_eq!((report.channels[1].name.as_str(), report.channels[1].mean), ("variance.electrons", Some(2.5)));
    let text = report.to_string();
    assert!(text.contains("electrons") && text.contains("2.500000e2"), "{text}");
}

#[test]
fn a_truncated_file_is_refused() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let bytes = encode_spectral(&cube::<Radiance>(0.0), None, &provenance()).expect("encodable");
    for fraction in [0.01, 0.3, 0.9] {
        let path = written(folder.path(), "a.exr", &bytes[..(bytes.len() as f64 * fraction) as usize]);
        let message = read_spectral(&path).expect_err("truncated").to_string();
        assert!(message.contains("a.exr: not a readable EXR file") && message.contains("truncated"), "{message}");
    }
}

#[test]
fn what_is_no_spectral_image_is_refused_in_words() {
    let folder = tempfile::tempdir().expect("temporary folder");
    let plane = encode_plane(&Plane::<MeanElectrons>::new(2, 2), None, &provenance()).expect("encodable");
    let message = read_spectral(&written(folder.path(), "a.exr", &plane)).expect_err("electrons").to_string();
    assert!(message.contains("contains electrons in e; expected spectral radiance in W.m^-2.sr^-1.nm^-1"), "{message}");
}

#[test]
fn environments_in_half_floats_and_lossy_compression_are_read() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/assets/hdri/city.exr");
    if !all_here("environments_in_half_floats_and_lossy_compression_are_read", &[&path]) {
        return;
    }
    let image = etendue_io::picture::read_image(&path).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!((image.width, image.height), (512, 256));
    let report = inspect(&path).expect("an environment");
    // Means by OpenEXR 3.5.3 (its own DWA decoder), summed in 64 bits. Half floats hold 3 decimals, and the decoders may
    // round the last one differently: over 131 072 pixels such differences average out to far below 1e-5.
    for (channel, mean) in report.channels.iter().zip([0.788_127_105, 0.671_765_218, 0.682_267_192]) {
        let own = channel.mean.expect("finite values");
        assert!(channel.stored_as == "half" && (own / mean - 1.0).abs() < 1e-5, "{}: {own}", channel.name);
    }
    assert_eq!(report.preview.expect("a picture").rgb.len(), 512 * 256);
}
