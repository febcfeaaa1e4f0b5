//! Images with an alpha channel, and triplanar images.

use super::*;

/// Texels of (grey, alpha), one row.
fn row(texels: &[(u8, u8)]) -> ImageTexture {
    let (colours, alpha) = texels.iter().map(|(g, a)| ([*g; 3], *a)).unzip();
    let clamp = Sampling { wrap: [Wrap::Clamp; 2], ..Sampling::default() };
    ImageTexture::with_alpha(texels.len() as u32, 1, Texels::Linear8(colours), alpha, clamp).expect("a picture")
}

fn wide() -> Lookup {
    Lookup { width: 1e6, ..Lookup::point(Vec2::splat(0.5)) }
}

#[test]
fn what_cannot_be_seen_gives_no_colour_to_what_can() {
    // A leaf of 0.2 on a white ground that is cut away: from afar it is still 0.2, with an opacity of a quarter.
    let leaf = row(&[(255, 0), (51, 255), (255, 0), (255, 0)]);
    assert!((leaf.sample(&wide())[0] - 0.2).abs() < 1e-6, "{:?}", leaf.sample(&wide()));
    assert!((leaf.channel(&wide(), Channel::Alpha) - 0.25).abs() < 1e-6);
    let half = row(&[(255, 51), (0, 204)]);
    assert!((half.sample(&wide())[0] - 0.2).abs() < 1e-6, "weighed by 0.2 and 0.8");
    let nothing = row(&[(255, 0), (51, 0)]);
    assert!((nothing.sample(&wide())[0] - 0.6).abs() < 1e-6, "where nothing is seen, the mean");
}

#[test]
fn alpha_is_read_like_any_channel() {
    let leaf = row(&[(255, 0), (51, 255)]);
    let at = |u: f32| leaf.channel(&Lookup::point(Vec2::new(u, 0.5)), Channel::Alpha);
    assert_eq!((at(0.25), at(0.75)), (0.0, 1.0));
    assert!((at(0.5) - 0.5).abs() < 1e-6);
    assert!(leaf.has_alpha() && leaf.channel_range(Channel::Alpha) == (0.0, 1.0));
    let faulty = ImageTexture::with_alpha(2, 1, Texels::Linear8(vec![[0; 3]; 2]), vec![0], Sampling::default());
    assert_eq!(faulty.err(), Some(TextureError::Size { width: 2, height: 1, actual: 1 }));
}

fn triplanar(size_m: f32, sharpness: f32) -> Sampling {
    Sampling { projection: Projection::Triplanar { size_m, sharpness }, ..Sampling::default() }
}

#[test]
fn an_image_from_three_sides_has_its_size_in_metres() {
    // Squares of 1 m along x and y, seen from above.
    let squares = test_image(2, 2, triplanar(2.0, 4.0), |x, y| if (x + y) % 2 == 0 { 0.0 } else { 1.0 });
    let at =
        |x: f32, y: f32| squares.sample(&Lookup { local: Vec3::new(x, y, 7.3), ..Lookup::point(Vec2::splat(0.1)) })[0];
    assert_eq!((at(0.5, 0.5), at(1.5, 0.5), at(0.5, 1.5), at(2.5, 0.5), at(-0.5, 0.5)), (1.0, 0.0, 0.0, 1.0, 0.0));
}

#[test]
fn an_image_from_three_sides_is_filtered_and_blended() {
    let ramp = test_image(64, 64, triplanar(1.0, 8.0), |x, y| ((x ^ y) & 1) as f32);
    let local_normal = Vec3::new(1.0, 1.0, 1.0).normalize();
    let place = Lookup { local: Vec3::new(0.3, 0.1, 0.7), local_normal, ..Lookup::point(Vec2::ZERO) };
    let filtered = Lookup { width_local: 1.0, ..place };
    assert!((ramp.sample(&filtered)[0] - 0.5).abs() < 1e-6);
    let value = ramp.sample(&place)[0];
    assert!((0.0..=1.0).contains(&value) && (ramp.channel(&place, Channel::Red) - value).abs() < 1e-7);
    assert!(!ramp.needs_uv());
    let faulty = |s| ImageTexture::new(1, 1, Texels::Linear8(vec![[0; 3]]), s).err();
    for (size, sharpness) in [(0.0, 4.0), (-1.0, 4.0), (1e-40, 4.0), (1.0, 0.5), (f32::NAN, 4.0)] {
        assert_eq!(faulty(triplanar(size, sharpness)), Some(TextureError::Projection), "{size} {sharpness}");
    }
}
