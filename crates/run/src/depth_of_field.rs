//! The words of a method of depth of field.

use etendue_optics::{DepthOfField, FastBlend, FastParameters};

pub(crate) fn parsed(text: &str) -> Result<DepthOfField, String> {
    match text.split_once(':') {
        None if text == "physical" => Ok(DepthOfField::Physical),
        None if text == "none" => Ok(DepthOfField::None),
        Some(("fast", keys)) => blend(keys).map(DepthOfField::Fast),
        _ => Err(format!("expected physical, none or fast:blur_px=…, not '{text}'")),
    }
}

fn blend(keys: &str) -> Result<FastBlend, String> {
    let (mut near, mut far, mut blur_px) = (None, None, None);
    for pair in keys.split(',') {
        let expected = || format!("expected blur_px=NUMBER, near_m=FROM..TO or far_m=FROM..TO, not '{pair}'");
        let number = |text: &str| text.trim().parse::<f64>().map_err(|_| expected());
        let (key, value) = pair.split_once('=').ok_or_else(expected)?;
        let range = || {
            let (from, to) = value.split_once("..").ok_or_else(expected)?;
            Ok::<_, String>((number(from)?, number(to)?))
        };
        match key.trim() {
            "blur_px" => blur_px = Some(number(value)?),
            "near_m" => near = Some(range()?),
            "far_m" => far = Some(range()?),
            _ => return Err(expected()),
        }
    }
    let blur_px = blur_px.ok_or("the diameter of the blur is missing: add blur_px=NUMBER")?;
    if near.is_none() && far.is_none() {
        return Err("nothing is blurred by this: add near_m=FROM..TO or far_m=FROM..TO".to_owned());
    }
    let (blurred_near_m, sharp_near_m) = near.unwrap_or((0.0, 0.0));
    let (sharp_far_m, blurred_far_m) = far.unwrap_or((f64::INFINITY, f64::INFINITY));
    let parameters = FastParameters { sharp_near_m, sharp_far_m, blurred_near_m, blurred_far_m, blur_px };
    FastBlend::new(parameters).map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_of_field_is_a_word_or_a_look_with_numbers() {
        assert_eq!(parsed("physical"), Ok(DepthOfField::Physical));
        assert_eq!(parsed("none"), Ok(DepthOfField::None));
        let look = parsed("fast:blur_px=8,far_m=10..40");
        let Ok(DepthOfField::Fast(blend)) = look else { panic!("{look:?}") };
        let p = blend.parameters();
        assert_eq!((p.blur_px, p.sharp_near_m, p.sharp_far_m, p.blurred_far_m), (8.0, 0.0, 10.0, 40.0));
        let wrong = [
            "fast",
            "fast:",
            "fast:blur_px=8",
            "fast:far_m=10..40",
            "fast:blur=8",
            "sharp",
            "fast:blur_px=8,far_m=10",
            "fast:blur_px=8,far_m=40..10",
        ];
        assert!(wrong.iter().all(|text| parsed(text).is_err()));
    }
}
