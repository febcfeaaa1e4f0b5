//! The words of the street's files: its light, its job, and where their numbers come from.

use crate::description::Description;
use crate::sky::ClearSky;

/// The scene file.
pub(super) fn scene(street: &Description, sky: &ClearSky) -> String {
    let [unique, placed] = street.triangle_counts();
    format!(
        "# A city street in sunlight. Made by scenes/generator; change the generator, not this file.\n\
         # {unique} triangles in files, {placed} with every instance.\n\
         # World: metres, x along the street, y to the left, z up; y = 0 is the middle of the carriageway.\n\
         # Class numbers are the label ids of the Cityscapes data set, and 40 for painted markings; the sky is 0.\n\
         # Reflectances are stand-ins from tables of albedo: asphalt 0.10 (Akbari, Pomerantz and Taha 2001), concrete 0.33,\n\
         # plaster 0.4 to 0.7, brick 0.2, leaves 0.06 / 0.12 / 0.03, worn road paint 0.55, rubber 0.04.\n\
         # Window glass is a coat of index 1.5 over a dark room: houses and cars have no inside.\n\
         # Paint and glass are as smooth as new ones. Where they throw the sun onto the road, a path finds it seldom and\n\
         # strongly: single bright pixels in a picture of few samples.\n\
         format = 1\n\n{tables}{light}",
        tables = street.toml(),
        light = light(sky)
    )
}

fn light(sky: &ClearSky) -> String {
    format!(
        "\n# Sky: CIE standard general sky type 12 (ISO 15469:2004), scaled to {diffuse} lx of diffuse light on a level plane;\n\
         # the picture holds cd/m². Ground below the horizon: a reflectance of 0.15 under sun and sky together.\n\
         [environment]\ntype = \"image\"\nfile = \"sky.hdr\"\nluminance_cd_m2_per_unit = 1\n\n\
         # Sun: 75 klx at right angles to the beam is usual on a clear day at this height (IES clear-day model, Gillette and\n\
         # Treado 1985: 127.5 klx exp(-0.21 / sin h) = 91 klx in clean air; hazier here). Colour: a stand-in for sunlight\n\
         # through two air masses.\n\
         [[lights]]\ntype = \"sun\"\nname = \"sun\"\nelevation_deg = {elevation}\nazimuth_deg = {azimuth}\n\
         illuminance_lx = 75000\ntemperature_k = 5300\n",
        diffuse = sky.diffuse_lx,
        elevation = sky.sun_elevation_deg,
        azimuth = sky.sun_azimuth_deg
    )
}

/// The job that renders the street.
pub(super) fn job() -> String {
    String::from(
        "# The street as the camera behind a car's wind-screen sees it. Made by scenes/generator.\n\
         format = 1\n\
         scene = \"scene.toml\"\n\n\
         [[cameras]]\n\
         name = \"front\"\n\
         file = \"../cameras/automotive.toml\"\n\
         # Behind the mirror of a car in the right lane, 1.35 m above the road, looking half a degree down.\n\
         position_m = [0, -1.6, 1.35]\n\
         rotation_deg = [0, 0.5, 0]\n\n\
         [render]\n\
         # About a minute on two cores.\n\
         spp = 64\n\
         replicates = 4\n\
         max_bounces = 6\n\
         # Sunlight that windows and paint throw on the road comes in a few very bright samples: a look without them. For\n\
         # a reference, set it to true and take many more samples.\n\
         caustics = false\n\
         seed = 1\n\
         # Twenty bands keep the radiance file small; electrons are folded beside them and do not depend on the width.\n\
         band_width_nm = 20\n\n\
         [output]\n\
         radiance = true\n\
         raw = true\n\
         picture = true\n\
         ground_truth = true\n\
         depth_png = true\n",
    )
}
