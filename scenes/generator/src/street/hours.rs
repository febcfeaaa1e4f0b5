//! The street at other hours: scenes that build on the street's own and change its light.

use core::fmt::Write as _;

use crate::luminaire;

/// Where a lamp's light leaves the lamp posts (see `furniture::lamp_post` and `layout::furniture`), m.
const STREET_LAMPS: [f64; 3] = [-39.0, -4.65, 7.06];
const STREET_LAMP_EVERY_M: f64 = 25.0;
const STREET_LAMP_COUNT: usize = 9;

/// Cars that drive towards the camera: x and y of their middle, how far ahead of it their lamps are and how far apart, and
/// how high, m.
pub(super) const ONCOMING: [[f64; 5]; 3] =
    [[25.5, 1.7, 2.05, 1.16, 0.70], [52.0, 1.65, 2.5, 1.4, 0.78], [74.0, 1.7, 2.3, 1.3, 0.70]];

/// What lies in the carriageway, and its reflectance when dry (see `materials`): water covers it when it rains.
const WET_ROAD: [(&str, &str); 4] = [
    ("asphalt", "{ texture = \"asphalt\" }"),
    ("fresh-asphalt", "{ texture = \"fresh-asphalt\" }"),
    ("bitumen", "[0.03, 0.03, 0.03]"),
    ("manhole", "[0.085, 0.08, 0.075]"),
];

/// The scene at sunset.
pub(super) fn sunset_scene() -> String {
    String::from(
        "# The street under a low sun, half an hour before sunset. Made by scenes/generator.\n\
         format = 1\n\
         base = \"scene.toml\"\n\n\
         [environment]\n\
         type = \"sky\"\n\
         turbidity = 3\n\
         ground_albedo = 0.15\n\
         sun_elevation_deg = 6\n\
         sun_azimuth_deg = 174\n",
    )
}

/// The scene at night.
pub(super) fn night_scene() -> String {
    let mut text = String::from(
        "# The street at night: street lamps, head lamps, lit windows. Made by scenes/generator.\n\
         format = 1\n\
         base = \"scene.toml\"\n\n\
         # A cloudy sky over a town throws back the light of its lamps: 0.02 cd/m2 is usual (Kyba et al. 2015).\n\
         [environment]\ntype = \"uniform\"\nluminance_cd_m2 = 0.02\ntemperature_k = 3000\n\n\
         # Curtains before rooms of some 50 lx.\n\
         [[materials]]\nname = \"curtain-glass\"\ntype = \"coated\"\nreflectance = [0.34, 0.33, 0.31]\nalpha = 0.001\n\
         emission = { luminance_cd_m2 = 6, temperature_k = 2800 }\n\n\
         # The glass of the street lamps, as bright as looks on beside the beam: the light on the road is the lamps' below.\n\
         [[materials]]\nname = \"lamp-glass\"\ntype = \"coated\"\nreflectance = [0.5, 0.5, 0.48]\nalpha = 0.1\n\
         emission = { luminance_cd_m2 = 3000, illuminant = \"LED-B3\" }\n\n\
         # The fronts of driving cars' head lamps: stray light of theirs. The beams are lamps of their own.\n\
         [[materials]]\nname = \"headlamp-driving\"\ntype = \"coated\"\nreflectance = [0.2, 0.21, 0.22]\nalpha = 0.002\n\
         emission = { luminance_cd_m2 = 1500, illuminant = \"LED-B5\" }\n\n\
         [[materials]]\nname = \"taillamp-driving\"\ntype = \"coated\"\nreflectance = [0.28, 0.012, 0.01]\nalpha = 0.002\n\
         emission = { luminance_cd_m2 = 60, rgb = [1, 0.005, 0.002] }\n",
    );
    let _ = writeln!(text, "\n# A stand-in for a LED luminaire: {} lm, made from a formula.", luminaire::FLUX_LM);
    text.push_str(&street_lamps("street-lamp.ies", ""));
    text.push_str(
        "\n# The camera's own car: low beam.\n\
         [[lights]]\nname = \"own-low-beam\"\ntype = \"head_lamp\"\nbeam = \"low_beam\"\ntraffic = \"right\"\n\
         illuminant = \"LED-B5\"\n\
         instances = [\n  { position_m = [1.9, -0.97, 0.65] },\n  { position_m = [1.9, -2.23, 0.65] },\n]\n\n\
         # Those that come towards it.\n\
         [[lights]]\nname = \"other-low-beam\"\ntype = \"head_lamp\"\nbeam = \"low_beam\"\ntraffic = \"right\"\n\
         illuminant = \"LED-B5\"\ninstances = [\n",
    );
    for [x, y, ahead, spacing, height] in ONCOMING {
        for side in [-0.5, 0.5] {
            let at = [x - ahead - 0.05, y + side * spacing, height].map(|v| (v * 1000.0).round() / 1000.0);
            let _ =
                writeln!(text, "  {{ position_m = [{}, {}, {}], rotation_deg = [180, 0, 0] }},", at[0], at[1], at[2]);
        }
    }
    text.push_str("]\n");
    text
}

/// The street's lamps by their photometric file, with further keys.
pub(super) fn street_lamps(file: &str, keys: &str) -> String {
    let mut text = format!(
        "[[lights]]\nname = \"street-lamp\"\ntype = \"measured\"\nfile = \"{file}\"\nilluminant = \"LED-B3\"\n{keys}instances = [\n"
    );
    let [x, y, z] = STREET_LAMPS;
    for i in 0..STREET_LAMP_COUNT {
        let _ = writeln!(text, "  {{ position_m = [{}, {y}, {z}] }},", x + STREET_LAMP_EVERY_M * i as f64);
    }
    text + "]\n"
}

/// The scene at night after rain: a film of water on the carriageway, over the textures and the paint of the dry one.
pub(super) fn wet_night_scene() -> String {
    let mut text = String::from(
        "# The street at night after rain: the carriageway is wet, the pavements have drained. Made by scenes/generator.\n\
         format = 1\n\
         base = \"scene-night.toml\"\n",
    );
    for (name, reflectance) in WET_ROAD {
        let _ =
            write!(text, "\n[[materials]]\nname = \"{name}\"\npreset = \"asphalt_wet\"\nreflectance = {reflectance}\n");
    }
    text.push_str("\n[[materials]]\nname = \"marking\"\npreset = \"marking_white_wet\"\n");
    text
}

/// A job that renders one of the scenes.
pub(super) fn job(comment: &str, scene: &str, camera: &str) -> String {
    format!(
        "# {comment} Made by scenes/generator.\n\
         format = 1\n\
         scene = \"{scene}\"\n\n\
         [[cameras]]\n\
         name = \"front\"\n\
         file = \"../cameras/{camera}\"\n\
         position_m = [0, -1.6, 1.35]\n\
         rotation_deg = [0, 0.5, 0]\n\n\
         [render]\n\
         spp = 64\n\
         max_bounces = 6\n\
         caustics = false\n\
         seed = 1\n"
    )
}
