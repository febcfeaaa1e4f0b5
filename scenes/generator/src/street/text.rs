//! The words of the street's files: its light, its job, and where their numbers come from.

use crate::description::Description;

/// The scene file.
pub(super) fn scene(street: &Description) -> String {
    let [unique, placed] = street.triangle_counts();
    format!(
        "# A city street in sunlight. Made by scenes/generator; change the generator, not this file.\n\
         # {unique} triangles in files, {placed} with every instance.\n\
         # World: metres, x along the street, y to the left, z up; y = 0 is the middle of the carriageway.\n\
         # Class numbers are the label ids of the Cityscapes data set, and 40 for painted markings; the sky is 0.\n\
         # Reflectances are stand-ins from tables of albedo: asphalt 0.10 (Akbari, Pomerantz and Taha 2001), concrete 0.33,\n\
         # plaster 0.4 to 0.7, brick 0.2, leaves 0.06 / 0.12 / 0.03.\n\
         # Window glass is a coat of index 1.5 over a dark room: houses and cars have no inside.\n\
         # Paint and glass are as smooth as new ones. Where they throw the sun onto the road, a path finds it seldom and\n\
         # strongly: single bright pixels in a picture of few samples.\n\
         format = 1\n\n{tables}{light}",
        tables = street.toml(),
        light = light()
    )
}

/// The light of a clear day.
fn light() -> &'static str {
    "\n# A clear sky with its sun, behind the camera and to the left. Light as of Hosek and Wilkie (2012, 2013).\n\
     [environment]\ntype = \"sky\"\nturbidity = 3\nground_albedo = 0.15\nsun_elevation_deg = 38\nsun_azimuth_deg = 150\n"
}

/// The job that renders the street.
pub(super) fn job() -> String {
    String::from(
        "# The street as the camera behind a car's windscreen sees it. Made by scenes/generator.\n\
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
