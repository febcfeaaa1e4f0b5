//! What stands where on the road and along it.

use super::furniture::{self as things, Board};
use super::road::{self, KERB_M, LANE_M, NOSE_X, PARKING_Y, REACH_X};
use super::tree::Growth;
use super::{fleet, person};
use crate::description::{Description, Placement};
use crate::random::RandomStream;
use glam::DVec3;
use rand::RngExt;

/// Road, pavements, kerbs.
pub(super) fn ground(street: &mut Description) {
    let flat = [
        ("earth", "terrain", road::earth()),
        ("carriageway", "road", road::carriageway()),
        ("repairs", "road", road::repairs()),
        ("parking", "parking", road::parking()),
        ("pavement", "sidewalk", road::pavement()),
        ("lawn", "terrain", road::lawn()),
        ("markings", "marking", road::markings()),
    ];
    for (name, class, mesh) in flat {
        street.mesh(name, mesh);
        street.object(name, class, vec![Placement::new(0.0, 0.0, 0.0, 0.0)]);
    }
    street.mesh("kerb", road::kerb());
    street.object("kerb", "sidewalk", kerbs());
}

/// Kerbs along both sides; at the crossing's nose the right one steps out to the lane.
fn kerbs() -> Vec<Placement> {
    let tens = (0..22).map(|i| REACH_X[0] + 10.0 * f64::from(i));
    let right = tens.clone().filter(|x| *x + 10.0 <= NOSE_X[0] || *x >= NOSE_X[1] - 10.0);
    let left = tens.map(|x| Placement::new(x + 10.0, LANE_M, 0.0, 180.0));
    let nose =
        [Placement::new(NOSE_X[0], -LANE_M - 0.1, 0.0, 0.0), Placement::new(NOSE_X[1] - 10.0, -LANE_M - 0.1, 0.0, 0.0)];
    right.map(|x| Placement::new(x, PARKING_Y, 0.0, 0.0)).chain(left).chain(nose).collect()
}

/// Trees and hedges.
pub(super) fn greenery(street: &mut Description) {
    let lime = Growth { trunk: 2.7, crown: [5.6, 2.6], leaves: 1400, key: 71 };
    let maple = Growth { trunk: 2.3, crown: [5.0, 2.3], leaves: 1150, key: 72 };
    street.mesh("tree-a", lime.mesh());
    street.mesh("tree-b", maple.mesh());
    street.mesh("hedge", things::hedge(DVec3::new(8.0, 0.7, 1.1), 420, 73));
    street.mesh("island", road::island());
    let mut dice = RandomStream::new(80);
    let mut trees = [Vec::new(), Vec::new()];
    let mut plant = |x: f64, y: f64, z: f64| {
        let kind = dice.random_range(0..2);
        let scale = (dice.random_range::<f64, _>(0.9..1.15) * 100.0).round() / 100.0;
        trees[kind].push(Placement { scale, ..Placement::new(x, y, z, 10.0 * f64::from(dice.random_range(0..36))) });
    };
    for i in 0..15 {
        let x = -46.0 + 14.0 * f64::from(i);
        if !(8.0..24.0).contains(&x) {
            plant(x, 4.15, KERB_M);
        }
    }
    for x in ISLANDS_X {
        plant(x, -4.4, KERB_M);
    }
    for (x, y) in [
        (33.0, 12.0),
        (39.5, 15.0),
        (45.0, 11.5),
        (36.0, 22.0),
        (43.0, 24.0),
        (33.5, 30.0),
        (40.0, 33.0),
        (46.0, 31.0),
        (22.0, 11.0),
        (27.5, 15.0),
        (24.0, 24.0),
        (29.0, 29.0),
    ] {
        plant(x, y, 0.1);
    }
    for y in [-7.0, 5.2, 11.0] {
        plant(REACH_X[1] + 12.5, y, KERB_M);
    }
    let [first, second] = trees;
    street.object("tree-a", "vegetation", first);
    street.object("tree-b", "vegetation", second);
    street.object("island", "sidewalk", ISLANDS_X.map(|x| Placement::new(x, -4.35, 0.0, 0.0)).to_vec());
    street.object("hedge", "vegetation", [19.5, 28.5, 39.0].map(|x| Placement::new(x, 7.6, KERB_M, 0.0)).to_vec());
}

/// Tree islands in the parking lane.
const ISLANDS_X: [f64; 5] = [-8.2, 48.2, 71.0, 93.8, 116.6];

/// Lamps, signs, bins, bollards, a bench.
pub(super) fn furniture(street: &mut Description) {
    street.mesh("lamp-post", things::lamp_post());
    let right = (0..9).map(|i| Placement::new(-39.0 + 25.0 * f64::from(i), -5.8, KERB_M, 0.0));
    street.object("lamp-post", "pole", right.collect());
    street.mesh("bollard", things::bollard());
    street.object("bollard", "pole", [13.2, 14.6, 21.4, 22.8].map(|x| Placement::new(x, -3.75, KERB_M, 0.0)).to_vec());
    street.mesh("bin", things::bin());
    street.object(
        "bin",
        "pole",
        vec![Placement::new(10.4, -5.85, KERB_M, 0.0), Placement::new(29.2, 7.0, KERB_M, 0.0)],
    );
    street.mesh("bench", things::bench());
    street.object("bench", "pole", vec![Placement::new(35.0, 6.7, KERB_M, 180.0)]);
    signs(street);
}

fn signs(street: &mut Description) {
    let limit = (Board::Round, 0.30, 2.45, "sign-limit");
    let crossing = (Board::Square, 0.30, 2.45, "sign-crossing");
    let posts: [(&'static str, Vec<things::Sign>, Vec<Placement>); 5] = [
        ("board-limit", vec![limit], vec![Placement::new(9.5, -5.75, KERB_M, 0.0)]),
        (
            "board-crossing",
            vec![crossing],
            vec![Placement::new(15.4, -3.85, KERB_M, 0.0), Placement::new(20.6, 3.75, KERB_M, 180.0)],
        ),
        (
            "board-priority",
            vec![(Board::Diamond, 0.30, 2.4, "sign-priority")],
            vec![Placement::new(26.2, -5.75, KERB_M, 0.0)],
        ),
        (
            "board-no-parking",
            vec![(Board::Round, 0.21, 2.3, "sign-no-parking")],
            vec![Placement::new(11.4, 3.75, KERB_M, 180.0), Placement::new(66.0, -5.75, KERB_M, 0.0)],
        ),
        (
            "board-danger",
            vec![(Board::Triangle, 0.45, 2.4, "sign-danger")],
            vec![Placement::new(43.0, -5.75, KERB_M, 0.0)],
        ),
    ];
    let mut standing = Vec::new();
    for (mesh, boards, spots) in posts {
        street.mesh(mesh, things::sign_boards(&boards));
        standing.extend(spots.iter().copied());
        street.object(mesh, "traffic-sign", spots);
    }
    street.mesh("post", things::sign_post(2.85));
    street.object("post", "pole", standing);
}

/// Cars and people.
pub(super) fn traffic(street: &mut Description) {
    street.mesh("saloon", fleet::saloon().mesh());
    street.mesh("hatchback", fleet::hatchback().mesh());
    street.mesh("van", fleet::van().mesh());
    let parked = |x: f64| Placement::new(x, -4.32, 0.0, 0.0);
    let parking: [(&'static str, &'static str, &'static str, Vec<f64>); 10] = [
        ("hatchback", "paint-red", "plate-2", vec![37.0, 65.4]),
        ("hatchback", "paint-white", "plate-3", vec![116.0]),
        ("van", "paint-white", "plate-1", vec![76.8]),
        ("saloon", "paint-silver", "plate-3", vec![27.8, -2.6, 99.6]),
        ("saloon", "paint-black", "plate-2", vec![42.5]),
        ("hatchback", "paint-green", "plate-1", vec![54.0, 105.2]),
        ("van", "paint-yellow", "plate-2", vec![59.7]),
        ("saloon", "paint-red", "plate-1", vec![82.3]),
        ("hatchback", "paint-blue", "plate-3", vec![7.4, 88.0]),
        ("hatchback", "paint-silver", "plate-2", vec![32.6, 110.9]),
    ];
    for (mesh, paint, plate, places) in parking {
        let name = format!("{mesh}-{}", paint.trim_start_matches("paint-"));
        let dress = vec![("paint", paint), ("plate", plate)];
        street.dressed(name, mesh, "car", dress, places.into_iter().map(parked).collect());
    }
    driving(street);
    people(street);
}

/// Cars under way, whose lamps are materials of their own.
fn driving(street: &mut Description) {
    let cars = [
        ("saloon", "paint-blue", "plate-1", Placement::new(29.5, -1.6, 0.0, 0.0)),
        ("hatchback", "paint-white", "plate-3", Placement::new(25.5, 1.7, 0.0, 180.0)),
        ("van", "paint-white", "plate-1", Placement::new(52.0, 1.65, 0.0, 180.0)),
        ("saloon", "paint-black", "plate-2", Placement::new(74.0, 1.7, 0.0, 180.0)),
        ("saloon", "paint-red", "plate-1", Placement::new(66.0, -1.65, 0.0, 0.0)),
    ];
    for (mesh, paint, plate, spot) in cars {
        let name = format!("{mesh}-{}-driving", paint.trim_start_matches("paint-"));
        let lamps = [("headlamp", "headlamp-driving"), ("taillamp", "taillamp-driving")];
        let dress = [[("paint", paint), ("plate", plate)], lamps].concat();
        street.dressed(name, mesh, "car", dress, vec![spot]);
    }
}

fn people(street: &mut Description) {
    street.mesh("walker", person::walker(0.62));
    let people = [
        ("walker", "coat-red", "trousers", Placement::new(13.4, -6.6, KERB_M, 0.0)),
        ("walker", "coat-blue", "trousers-beige", Placement::new(18.4, 3.75, KERB_M, -90.0)),
        ("walker", "coat-grey", "trousers", Placement::new(31.0, 6.0, KERB_M, 180.0)),
        ("walker", "coat-blue", "trousers", Placement::new(38.0, -6.9, KERB_M, 180.0)),
    ];
    for (i, (mesh, coat, trousers, spot)) in people.into_iter().enumerate() {
        let dress = vec![("coat", coat), ("trousers", trousers)];
        street.dressed(format!("person-{}", i + 1), mesh, "person", dress, vec![spot]);
    }
}
