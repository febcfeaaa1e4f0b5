//! Surfaces and textures of the street.

use crate::description::Surface::{Coated, Conductor, Diffuse, Leaf, Preset, Sign, Textured};
use crate::description::{Description, Material};
use crate::paint::{brick, grass, ground, plates, roof, signs};
use glam::DVec3;

/// Every material.
pub(super) fn all() -> Vec<Material> {
    [ROAD, WALLS, PLANTS, FURNITURE, CARS, PEOPLE].concat()
}

const ROAD: &[Material] = &[
    ("asphalt", Textured("asphalt")),
    ("fresh-asphalt", Textured("fresh-asphalt")),
    ("bitumen", Coated([0.03, 0.03, 0.03], 0.35)),
    ("marking", Preset("marking_white")),
    ("slabs", Textured("slabs")),
    ("kerb", Diffuse([0.36, 0.35, 0.33])),
    ("manhole", Diffuse([0.085, 0.08, 0.075])),
    ("earth", Diffuse([0.16, 0.14, 0.09])),
    ("grass", Textured("grass")),
];

const WALLS: &[Material] = &[
    ("plaster-white", Diffuse([0.70, 0.69, 0.65])),
    ("plaster-cream", Diffuse([0.66, 0.58, 0.42])),
    ("plaster-ochre", Diffuse([0.56, 0.38, 0.18])),
    ("plaster-rose", Diffuse([0.56, 0.36, 0.30])),
    ("plaster-grey", Diffuse([0.42, 0.43, 0.42])),
    ("plaster-green", Diffuse([0.40, 0.48, 0.37])),
    ("plaster-blue", Diffuse([0.36, 0.44, 0.52])),
    ("brick", Textured("brick")),
    ("brick-plain", Diffuse([0.28, 0.13, 0.09])),
    ("stone", Diffuse([0.50, 0.47, 0.41])),
    ("tiles", Textured("tiles")),
    ("zinc", Diffuse([0.36, 0.38, 0.40])),
    ("frame", Coated([0.72, 0.72, 0.70], 0.15)),
    ("shutter", Diffuse([0.55, 0.54, 0.50])),
    ("glass", Coated([0.02, 0.022, 0.022], 0.001)),
    ("curtain-glass", Coated([0.34, 0.33, 0.31], 0.001)),
    ("door", Coated([0.05, 0.09, 0.06], 0.12)),
    ("shop-frame", Coated([0.06, 0.06, 0.065], 0.20)),
    ("metal", Coated([0.10, 0.10, 0.11], 0.25)),
    ("board-cafe", Textured("board-cafe")),
    ("board-optik", Textured("board-optik")),
    ("board-brot", Textured("board-brot")),
];

const PLANTS: &[Material] = &[
    ("leaf", Leaf([0.055, 0.115, 0.025], [0.035, 0.085, 0.008])),
    ("leaf-light", Leaf([0.09, 0.165, 0.035], [0.06, 0.125, 0.012])),
    ("hedge", Diffuse([0.02, 0.04, 0.01])),
    ("bark", Diffuse([0.13, 0.10, 0.075])),
];

const FURNITURE: &[Material] = &[
    ("galvanised", Diffuse([0.34, 0.35, 0.36])),
    ("lamp-glass", Coated([0.50, 0.50, 0.48], 0.10)),
    ("bin", Coated([0.48, 0.14, 0.02], 0.25)),
    ("bollard", Coated([0.045, 0.05, 0.055], 0.20)),
    ("wood", Diffuse([0.30, 0.19, 0.10])),
    ("sign-limit", Sign("ra2", "sign-limit")),
    ("sign-priority", Sign("ra2", "sign-priority")),
    ("sign-no-parking", Sign("ra2", "sign-no-parking")),
    ("sign-danger", Sign("ra2", "sign-danger")),
    ("sign-crossing", Sign("ra2", "sign-crossing")),
    ("sign-street", Sign("ra1", "sign-street")),
];

const CARS: &[Material] = &[
    ("paint-silver", Preset("car_paint_silver")),
    ("paint-white", Coated([0.74, 0.74, 0.73], 0.005)),
    ("paint-black", Coated([0.012, 0.012, 0.013], 0.005)),
    ("paint-red", Coated([0.36, 0.018, 0.016], 0.005)),
    ("paint-blue", Preset("car_paint_metallic_blue")),
    ("paint-green", Coated([0.03, 0.09, 0.06], 0.005)),
    ("paint-yellow", Coated([0.66, 0.36, 0.02], 0.005)),
    ("trim", Coated([0.025, 0.025, 0.026], 0.35)),
    ("gap", Diffuse([0.01, 0.01, 0.01])),
    ("grille", Coated([0.02, 0.02, 0.02], 0.20)),
    ("headlamp", Coated([0.20, 0.21, 0.22], 0.002)),
    ("taillamp", Coated([0.28, 0.012, 0.010], 0.002)),
    ("headlamp-driving", Coated([0.20, 0.21, 0.22], 0.002)),
    ("taillamp-driving", Coated([0.28, 0.012, 0.010], 0.002)),
    ("rubber", Preset("rubber")),
    ("alloy", Conductor("Al", 0.25)),
    ("plate-1", Sign("ra1", "plate-1")),
    ("plate-2", Sign("ra1", "plate-2")),
    ("plate-3", Sign("ra1", "plate-3")),
];

const PEOPLE: &[Material] = &[
    ("skin", Preset("skin_light")),
    ("hair", Diffuse([0.05, 0.03, 0.02])),
    ("trousers", Diffuse([0.05, 0.06, 0.10])),
    ("trousers-beige", Diffuse([0.34, 0.28, 0.19])),
    ("coat-red", Diffuse([0.40, 0.06, 0.05])),
    ("coat-blue", Diffuse([0.07, 0.12, 0.26])),
    ("coat-grey", Diffuse([0.25, 0.25, 0.26])),
];

/// Paints every texture.
pub(super) fn paint(street: &mut Description) {
    street.grey_texture("asphalt", &ground::lane(), 8);
    street.grey_texture("fresh-asphalt", &ground::fresh(), 4);
    street.grey_texture("slabs", &ground::slabs(), 4);
    street.texture("brick", &brick::brick());
    street.texture("tiles", &roof::tiles());
    street.texture("grass", &grass::grass());
    street.texture("sign-limit", &signs::limit_30());
    street.texture("sign-priority", &signs::priority());
    street.texture("sign-no-parking", &signs::no_parking());
    street.texture("sign-danger", &signs::danger());
    street.texture("sign-crossing", &signs::crossing());
    let (white, blue) = (DVec3::splat(0.62), DVec3::new(0.02, 0.10, 0.42));
    street.texture("sign-street", &signs::board("LAMBERTSTR", [192, 32], blue, DVec3::splat(0.97)));
    let (dark, gold) = (DVec3::splat(0.03), DVec3::new(0.55, 0.36, 0.10));
    street.texture("board-cafe", &signs::board("CAFE ABBE", [256, 32], DVec3::new(0.22, 0.03, 0.03), white));
    street.texture("board-optik", &signs::board("OPTIK PETZVAL", [256, 32], dark, gold));
    street.texture("board-brot", &signs::board("BROT", [256, 32], DVec3::new(0.05, 0.14, 0.07), gold));
    for (name, text) in [("plate-1", "B ET 2031"), ("plate-2", "HH DU 481"), ("plate-3", "M E 1905")] {
        street.texture(name, &plates::plate(text));
    }
}
