use super::*;
use crate::frame::tests::{ADDRESS, quiet, run};
use crate::{cfa::BayerPhase, parameters::SensorParameters, sensor::Sensor};

#[test]
fn binning_keeps_colours_apart_and_counts_all_charge() {
    let mut p = quiet();
    let channel = p.channels[0].clone();
    p.channels = ["r", "g", "b"].map(|name| crate::Channel { name: name.into(), ..channel.clone() }).to_vec();
    p.cfa = Cfa::bayer(BayerPhase::Rggb);
    p.charge.full_well.capacity_e = 1e5;
    let mut means = Plane::new(8, 4);
    for (x, y) in (0..32).map(|i| (i % 8, i / 8)) {
        means.set(x, y, [100.0, 200.0, 300.0][p.cfa.channel_at(x, y)]);
    }
    let mut binned = |of| {
        p.read_out.layout.binning = Some(Binning { columns: 2, rows: 2, of });
        run(&p, &means, ADDRESS).plane
    };
    let charge = binned(BinningMode::Charge);
    assert_eq!((charge.width(), charge.height()), (4, 2));
    assert_eq!(charge.samples(), [400, 800, 400, 800, 800, 1200, 800, 1200]);
    assert_eq!(binned(BinningMode::Numbers).samples(), [100, 200, 100, 200, 200, 300, 200, 300]);
}

#[test]
fn a_region_is_a_part_of_the_whole() {
    let mut p = quiet();
    p.noise = true;
    let means = Plane::from_samples(10, 6, (0..60).map(|i| 10.0 * i as f32).collect()).expect("filled");
    let full_frame = run(&p, &means, ADDRESS).plane;
    let region = Region { x: 3, y: 2, width: 4, height: 3 };
    p.read_out.layout.region = Some(region);
    assert_eq!(run(&p, &means, ADDRESS).plane, region.crop(&full_frame));
}

#[test]
fn the_delivered_image_has_its_size_and_its_coordinates() {
    let mut p = quiet();
    p.read_out.layout.region = Some(Region { x: 2, y: 2, width: 8, height: 4 });
    p.read_out.layout.binning = Some(Binning { columns: 2, rows: 1, of: BinningMode::Numbers });
    let raw = run(&p, &Plane::filled(10, 6, 500.0), ADDRESS);
    let sensor = Sensor::new(p).expect("legal");
    assert_eq!((raw.plane.width(), raw.plane.height()), (4, 4));
    assert_eq!(sensor.image_size(10, 6), (4, 4));
    assert_eq!(sensor.to_image([5.0, 3.0]), [1.5, 1.0]);
}

/// Bayer tiles: of every two columns and three rows of tiles only the first is read, of 8 × 12 pixels that each hold their own number.
#[test]
fn skipped_tiles_are_not_in_the_raw_and_leave_the_others_as_they_are() {
    let mut p = quiet();
    p.cfa = Cfa::bayer(BayerPhase::Rggb);
    let channel = p.channels[0].clone();
    p.channels = ["r", "g", "b"].map(|name| crate::Channel { name: name.into(), ..channel.clone() }).to_vec();
    p.noise = true;
    let means = Plane::from_samples(8, 12, (0..96).map(|i| 10.0 * i as f32).collect()).expect("filled");
    let full_frame = run(&p, &means, ADDRESS).plane;
    p.read_out.layout.skipping = Some(Skipping { columns: 2, rows: 3 });
    let read = run(&p, &means, ADDRESS).plane;
    assert_eq!((read.width(), read.height()), (4, 4));
    for (i, x) in [0, 1, 4, 5].into_iter().enumerate() {
        for (j, y) in [0, 1, 6, 7].into_iter().enumerate() {
            assert_eq!(read.at(i, j), full_frame.at(x, y));
            assert_eq!(p.read_out.layout.raw_of_array(&p.cfa, x, y), Some((i, j)));
        }
    }
    assert_eq!(p.read_out.layout.raw_of_array(&p.cfa, 2, 1), None);
    let region = Region { x: 4, y: 6, width: 4, height: 6 };
    p.read_out.layout.region = Some(region);
    let part = run(&p, &means, ADDRESS).plane;
    assert_eq!(part, Region { x: 2, y: 2, width: 2, height: 2 }.crop(&read));
}

/// The centre of the tile that is read, and of the next one.
#[test]
fn points_of_a_thinned_image_lie_where_its_tiles_do() {
    let mut layout = Layout { skipping: Some(Skipping { columns: 2, rows: 3 }), ..Layout::default() };
    let bayer = Cfa::bayer(BayerPhase::Rggb);
    assert_eq!(layout.image_point(&bayer, [1.0, 1.0]), [1.0, 1.0]);
    assert_eq!(layout.image_point(&bayer, [5.0, 7.0]), [3.0, 3.0]);
    layout.region = Some(Region { x: 4, y: 6, width: 4, height: 6 });
    assert_eq!(layout.image_point(&bayer, [5.0, 7.0]), [1.0, 1.0]);
    let mono = Cfa::mono();
    layout.region = None;
    assert_eq!(layout.image_point(&mono, [2.5, 3.5]), [1.5, 1.5]);
}

#[test]
fn optical_black_sees_heat_and_no_light() {
    let mut p = quiet();
    p.charge.dark.current_e_s = 10.0 / p.exposure.exposure_s;
    p.read_out.layout.optical_black = OpticalBlack { rows: 2, columns: 3 };
    let raw = run(&p, &Plane::filled(5, 4, 500.0), ADDRESS);
    let black = raw.linear().optical_black.expect("rows without light");
    assert!(black.height() == 2 && black.samples().iter().all(|dn| *dn == 10));
    p.read_out.layout.optical_black = OpticalBlack { rows: 0, columns: 3 };
    let optical_black =
        run(&p, &Plane::filled(5, 4, 500.0), ADDRESS).linear().optical_black.expect("columns without light");
    assert!(
        (optical_black.width(), optical_black.height()) == (3, 4) && optical_black.samples().iter().all(|dn| *dn == 10)
    );
    assert_eq!(raw.image, Region { x: 3, y: 2, width: 5, height: 4 });
    for (x, y) in (0..48).map(|i| (i % 8, i / 8)) {
        assert_eq!(raw.plane.at(x, y), if x >= 3 && y >= 2 { 510 } else { 10 });
    }
}

#[test]
fn what_does_not_fit_is_refused() {
    let errors = |change: &dyn Fn(&mut SensorParameters)| {
        let mut p = quiet();
        change(&mut p);
        Sensor::new(p).expect("legal").image_size_errors(10, 6).len()
    };
    assert_eq!(errors(&|_| ()), 0);
    assert_eq!(errors(&|p| p.cfa = Cfa::tile(4, 1, vec![0; 4]).expect("a tile")), 1);
    assert_eq!(
        errors(&|p| p.read_out.layout.binning = Some(Binning { columns: 3, rows: 1, of: BinningMode::Charge })),
        1
    );
    let skipping = Some(Skipping { columns: 1, rows: 4 });
    assert_eq!(errors(&|p| p.read_out.layout.skipping = skipping), 1, "rows left over");
    assert_eq!(errors(&|p| p.read_out.layout.skipping = Some(Skipping { columns: 1, rows: 1 })), 1);
    let both = |p: &mut SensorParameters| {
        p.read_out.layout.skipping = Some(Skipping { columns: 2, rows: 2 });
        p.read_out.layout.binning = Some(Binning { columns: 2, rows: 2, of: BinningMode::Charge });
    };
    assert_eq!(errors(&both), 1);
    for x in [8, usize::MAX] {
        assert_eq!(errors(&|p| p.read_out.layout.region = Some(Region { x, y: 0, width: 4, height: 1 })), 1);
    }
}
