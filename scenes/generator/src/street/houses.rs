//! The kinds of houses and the rows they stand in.

use super::house::{Ground, House, Roof};
use super::road::{FRONT_Y, KERB_M, REACH_X};
use crate::description::{Description, Placement};

/// Names and shapes of the kinds of houses.
fn kinds() -> [(&'static str, House); 7] {
    let base = House {
        width: 12.0,
        depth: 11.0,
        storeys: 4,
        bays: 5,
        window: [1.15, 1.6],
        surrounds: true,
        balconies: false,
        ground: Ground::Home,
        roof: Roof::Pitched(2),
        key: 1,
    };
    [
        ("house-a", base),
        (
            "house-b",
            House { width: 9.0, storeys: 3, bays: 3, ground: Ground::Shop, roof: Roof::Pitched(1), key: 2, ..base },
        ),
        (
            "house-c",
            House {
                width: 14.0,
                bays: 5,
                window: [1.7, 1.5],
                surrounds: false,
                balconies: true,
                ground: Ground::Shop,
                roof: Roof::Flat,
                key: 3,
                ..base
            },
        ),
        ("house-d", House { width: 10.0, storeys: 5, bays: 4, window: [1.05, 1.75], key: 4, ..base }),
        (
            "house-e",
            House { width: 8.0, storeys: 3, bays: 3, surrounds: false, roof: Roof::Pitched(1), key: 5, ..base },
        ),
        ("house-f", House { width: 11.0, bays: 4, ground: Ground::Shop, key: 6, ..base }),
        (
            "house-g",
            House {
                width: 13.0,
                bays: 4,
                window: [1.9, 1.45],
                surrounds: false,
                balconies: true,
                roof: Roof::Flat,
                key: 7,
                ..base
            },
        ),
    ]
}

/// Rows of houses: kind, wall and the board above the shop.
type Row = &'static [(usize, &'static str, &'static str)];

const RIGHT: Row = &[
    (0, "plaster-cream", ""),
    (3, "plaster-grey", ""),
    (5, "plaster-white", "board-brot"),
    (4, "plaster-green", ""),
    (2, "plaster-white", "board-optik"),
    (0, "brick", ""),
    (1, "plaster-rose", "board-cafe"),
    (3, "plaster-white", ""),
    (5, "plaster-ochre", "board-brot"),
    (6, "plaster-grey", ""),
    (4, "plaster-blue", ""),
    (0, "plaster-rose", ""),
    (1, "brick", "board-optik"),
    (3, "plaster-cream", ""),
    (2, "plaster-grey", "board-cafe"),
    (0, "plaster-white", ""),
    (5, "plaster-green", "board-brot"),
    (4, "plaster-ochre", ""),
    (3, "brick", ""),
    (0, "plaster-cream", ""),
];

const LEFT: Row = &[
    (3, "brick", ""),
    (5, "plaster-rose", "board-optik"),
    (0, "plaster-white", ""),
    (4, "plaster-cream", ""),
    (1, "plaster-ochre", "board-brot"),
    (0, "plaster-blue", ""),
    (3, "plaster-cream", ""),
    (6, "brick", ""),
    (1, "brick", "board-cafe"),
    (5, "plaster-green", "board-optik"),
    (0, "plaster-ochre", ""),
    (2, "plaster-cream", "board-brot"),
    (3, "plaster-rose", ""),
    (4, "plaster-white", ""),
    (0, "brick", ""),
    (5, "plaster-grey", "board-cafe"),
    (3, "plaster-green", ""),
    (1, "plaster-cream", "board-optik"),
];

const ACROSS: Row = &[
    (0, "plaster-grey", ""),
    (3, "brick", ""),
    (5, "plaster-cream", "board-cafe"),
    (0, "plaster-white", ""),
    (3, "plaster-rose", ""),
];

/// The houses that close the view across the park.
const BEHIND_PARK: Row =
    &[(0, "plaster-rose", ""), (3, "plaster-white", ""), (0, "brick", ""), (4, "plaster-cream", "")];

/// And those that look along the park from behind the first house after it.
const BESIDE_PARK: Row = &[(0, "plaster-white", ""), (4, "plaster-ochre", "")];

/// The gap in the left row where the sun reaches the road.
const PARK_X: [f64; 2] = [18.0, 48.0];

/// The houses on both sides and across the ends.
pub(super) fn add(street: &mut Description) {
    let kinds = kinds();
    for (name, house) in &kinds {
        street.mesh(name, house.mesh());
    }
    let mut x = REACH_X[0] + 2.0;
    for &house in RIGHT {
        let width = kinds[house.0].1.width;
        add_house(street, &kinds, house, Placement::new(x + width, FRONT_Y[0], KERB_M, 180.0));
        x += width;
    }
    x = REACH_X[0] + 4.0;
    for &house in LEFT {
        let width = kinds[house.0].1.width;
        if x + width > PARK_X[0] && x < PARK_X[1] {
            x = PARK_X[1];
        }
        add_house(street, &kinds, house, Placement::new(x, FRONT_Y[1], KERB_M, 0.0));
        x += width;
    }
    x = 12.0;
    for &house in BEHIND_PARK {
        add_house(street, &kinds, house, Placement::new(x, 38.0, KERB_M, 0.0));
        x += kinds[house.0].1.width;
    }
    let mut y = 41.0;
    for &house in BESIDE_PARK {
        add_house(street, &kinds, house, Placement::new(62.0, y, KERB_M, -90.0));
        y -= kinds[house.0].1.width;
    }
    let (mut far, mut near) = (28.0, -28.0);
    for &house in ACROSS {
        let width = kinds[house.0].1.width;
        add_house(street, &kinds, house, Placement::new(REACH_X[1] + 16.0, far, KERB_M, -90.0));
        add_house(street, &kinds, house, Placement::new(REACH_X[0] - 2.0, near, KERB_M, 90.0));
        far -= width;
        near += width;
    }
}

fn add_house(
    street: &mut Description,
    kinds: &[(&'static str, House)],
    house: (usize, &'static str, &'static str),
    spot: Placement,
) {
    let (kind, wall, board) = house;
    let mesh = kinds[kind].0;
    let mut dress = vec![("wall", wall)];
    if !board.is_empty() {
        dress.push(("board", board));
    }
    let same = street.objects.iter().position(|object| object.mesh == mesh && object.dress == dress);
    match same {
        Some(index) => street.objects[index].spots.push(spot),
        None => street.dressed(house_name(mesh, wall, board), mesh, "building", dress, vec![spot]),
    }
}

fn house_name(mesh: &str, wall: &str, board: &str) -> String {
    format!("{mesh}-{}{}", wall.trim_start_matches("plaster-"), board.trim_start_matches("board"))
}
