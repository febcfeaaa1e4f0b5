use super::*;

#[test]
fn angles_turn_back_to_the_rotation() {
    let angles = [[0.3, -0.2, 0.1], [-3.0, 1.2, -2.0], [0.7, 0.0, 0.0], [0.4, core::f64::consts::FRAC_PI_2, 0.0]];
    for [yaw, pitch, roll] in angles {
        let turned = DMat3::from_rotation_z(yaw) * DMat3::from_rotation_y(pitch) * DMat3::from_rotation_x(roll);
        let [y, p, r] = yaw_pitch_roll(&turned);
        let again = DMat3::from_rotation_z(y) * DMat3::from_rotation_y(p) * DMat3::from_rotation_x(r);
        assert!((again - turned).to_cols_array().iter().all(|d| d.abs() < 1e-9), "{yaw} {pitch} {roll}");
        assert!([(y, yaw), (p, pitch), (r, roll)].iter().all(|(a, b)| (a - b).abs() < 1e-9), "{y} {p} {r}");
    }
}

#[test]
fn times_before_the_beginning_have_nanoseconds_above_0() {
    assert_eq!(timestamp((-0.25).into()), ProtobufMessage::default().varint(1, u64::MAX).varint(2, 750_000_000));
    assert_eq!(timestamp(2.0.into()), ProtobufMessage::default().varint(1, 2).varint(2, 0));
}

#[test]
fn classes_have_the_kinds_of_the_standard() {
    assert_eq!(OsiObjectType::from_class("Car", false), Some(OsiObjectType::Vehicle(4)));
    assert_eq!(OsiObjectType::from_class("guard_rail", false), Some(OsiObjectType::Stationary(8)));
    assert_eq!(OsiObjectType::from_class("person", false), Some(OsiObjectType::Mover(PEDESTRIAN)));
    assert_eq!(
        [OsiObjectType::from_class("crate", false), OsiObjectType::from_class("crate", true)],
        [Some(OsiObjectType::Stationary(1)), Some(OsiObjectType::Mover(1))]
    );
    assert_eq!([OsiObjectType::from_class("road", false), OsiObjectType::from_class("sky", false)], [None, None]);
    assert_eq!(OsiObjectType::Vehicle(12).moving_type(), Some(VEHICLE));
}

#[test]
fn names_follow_the_convention() {
    assert_eq!(trace_name(0.25, [3, 8, 0], 2, 17), "19700101T000000Z_gt_380_6302_2_000017.osi");
    // Time of the convention's own example.
    assert_eq!(stamp(1_629_299_142.0), "20210818T150542Z");
    assert_eq!(stamp(-0.25), "19691231T235959Z");
    assert_eq!(stamp(951_782_400.0), "20000229T000000Z");
    assert_eq!(stamp(f64::MAX), "99991231T235959Z");
    assert_eq!(stamp(f64::MIN), "00010101T000000Z");
}

/// Examples of the encoding's own description.
#[test]
fn bytes_are_those_of_the_description() {
    assert_eq!(ProtobufMessage::default().varint(1, 150).bytes(), [0x08, 0x96, 0x01]);
    assert_eq!(
        ProtobufMessage::default().text(2, "testing").bytes(),
        [0x12, 0x07, 0x74, 0x65, 0x73, 0x74, 0x69, 0x6e, 0x67]
    );
    let inner = ProtobufMessage::default().varint(1, 150);
    assert_eq!(ProtobufMessage::default().message(3, &inner).bytes(), [0x1a, 0x03, 0x08, 0x96, 0x01]);
    assert_eq!(
        ProtobufMessage::default().varint(1, (-2_i64) as u64).bytes(),
        [0x08, 0xfe, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01]
    );
    assert_eq!(ProtobufMessage::default().double(1, 1.0).bytes(), [0x09, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f]);
}
