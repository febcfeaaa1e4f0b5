"""Data sets for compositing, robots and annotation tools, read by the formats' own readers."""

import io
import json
import struct

import numpy as np
import pytest
from conftest import ROOT
from PIL import Image

import etendue

SIZE = {"width_px": 96, "height_px": 72, "pixel_pitch_um": 250}
FORMATS = ["cryptomatte", "openlabel", "mcap"]
# A block of some 25 × 25 px: centres of pixels count an edge along rows or columns to half a pixel, two of them to 25 px.
EDGES = 25


@pytest.fixture(scope="module")
def boxes(tmp_path_factory):
    """Two Cornell boxes, sixteen samples a pixel."""
    folder = tmp_path_factory.mktemp("boxes") / "set"
    changes = {f"cameras.front.sensor.{key}": value for key, value in SIZE.items()}
    etendue.dataset(ROOT / "scenes/cornell/cornell.toml", output=folder, samples=range(0, 2), format=FORMATS, spp=16, integrator="flat", set=changes)
    return folder


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Two frames of a camera of the drive."""
    folder = tmp_path_factory.mktemp("drive") / "set"
    changes = {"cameras.right": None, "cameras.rear": None, "cameras.left.output": None}
    sizes = {f"cameras.left.sensor.{key}": value for key, value in {"width_px": 96, "height_px": 60, "pixel_pitch_um": 60}.items()}
    etendue.dataset(ROOT / "scenes/drive/drive.toml", output=folder, frames=range(0, 2), spp=1, integrator="flat", set={**changes, **sizes}, format=["mcap", "openlabel", "osi"])
    return folder


def pictures(folder):
    """Records of samples with their pictures."""
    samples = [json.loads(path.read_text()) for path in sorted((folder / "samples").glob("*.json"))]
    return [(sample, picture) for sample in samples for picture in sample["pictures"]]


def stem(sample, picture):
    return f"{sample['sample']:06}_{picture['camera']}_{picture['frame']:04}"


def identity(mmh3, name):
    """The specification's own lines for the conversion of a hash."""
    hashed = mmh3.hash(name.encode(), signed=False)
    if (hashed >> 23 & 255) in (0, 255):
        hashed ^= 1 << 23
    return struct.unpack("<f", struct.pack("<I", hashed))[0], f"{hashed:08x}"


def test_cryptomatte_s_identities_are_the_hashes_of_names(boxes):
    mmh3, exr = pytest.importorskip("mmh3"), pytest.importorskip("OpenEXR")
    for sample, picture in pictures(boxes):
        name = boxes / f"cryptomatte/train/{stem(sample, picture)}.exr"
        assert name.with_suffix(".png").is_file()
        with exr.File(str(name), separate_channels=True) as file:
            header, channels = dict(file.header()), {key: np.array(channel.pixels) for key, channel in file.channels().items()}
        for layer in ("CryptoObject", "CryptoMaterial"):
            key = f"cryptomatte/{mmh3.hash(layer.encode(), signed=False):08x}"[: len("cryptomatte/") + 7]
            facts = {fact: header[f"{key}/{fact}"] for fact in ("name", "hash", "conversion", "manifest")}
            assert (facts["name"], facts["hash"], facts["conversion"]) == (layer, "MurmurHash3_32", "uint32_to_float32")
            manifest = json.loads(facts["manifest"])
            known = {identity(mmh3, name)[0]: name for name in manifest}
            assert all(identity(mmh3, name)[1] == digits for name, digits in manifest.items())
            ranks = [(channels[f"{layer}{rank // 2:02}.{'RB'[rank % 2]}"], channels[f"{layer}{rank // 2:02}.{'GA'[rank % 2]}"]) for rank in range(6)]
            coverage = np.array([share for _, share in ranks])
            assert (np.diff(coverage, axis=0) <= 0).all() and (coverage.sum(axis=0) <= 1 + 1e-6).all()
            assert all(((ids == 0) == (shares == 0)).all() for ids, shares in ranks)
            assert {float(number) for ids, _ in ranks for number in np.unique(ids)} - {0.0} <= set(known)
        # A block's coverage is its mask but for its edges: pixels of the mask have more than none of it.
        assert {"short-block", "tall-block", "lamp"} <= set(json.loads(header["cryptomatte/3ae39a5/manifest"]))
        shown = {entry["name"]: entry["visible_pixels"] for entry in picture["objects"]}
        block = identity(mmh3, "short-block")[0]
        area = sum(np.where(channels[f"CryptoObject0{rank // 2}.{'RB'[rank % 2]}"] == np.float32(block), channels[f"CryptoObject0{rank // 2}.{'GA'[rank % 2]}"], 0).sum() for rank in range(6))
        assert abs(area - shown["short-block"]) < EDGES, (area, shown["short-block"])
        assert ((channels["CryptoObject00.G"] > 0.05) & (channels["CryptoObject00.G"] < 0.95)).any(), "edges are soft"


def test_cryptomatte_s_masks_are_found_by_an_independent_reader(boxes):
    reader = pytest.importorskip("cryptomatte_api")
    sample, picture = pictures(boxes)[0]
    mattes = reader.Cryptomatte.load(str(boxes / f"cryptomatte/train/{stem(sample, picture)}.exr"), load_preview=False)
    matte = next(matte for matte in (mattes if isinstance(mattes, list) else [mattes]) if matte.metadata().name() == "CryptoObject")
    mask = np.asarray(matte.mask("short-block"))
    assert mask.max() == pytest.approx(1) and mask.min() == 0
    shown = {entry["name"]: entry["visible_pixels"] for entry in picture["objects"]}
    assert abs(mask.sum() - shown["short-block"]) < EDGES


def messages(name):
    """Messages by topic, decoded."""
    reader = pytest.importorskip("mcap.reader")
    decoder = pytest.importorskip("mcap_ros2.decoder")
    found = {}
    with open(name, "rb") as file:
        opened = reader.make_reader(file, decoder_factories=[decoder.DecoderFactory()])
        summary = opened.get_summary()
        for _, channel, message, decoded in opened.iter_decoded_messages():
            found.setdefault(channel.topic, []).append((message.log_time, decoded))
    assert summary.statistics.message_count == sum(map(len, found.values())) and summary.statistics.channel_count == len(found)
    return found


def test_mcap_has_our_pictures_depth_cameras_and_poses(drive):
    (name,) = (drive / "mcap/train").glob("*.mcap")
    found = messages(name)
    assert set(found) == {"/left/image/compressed", "/left/depth", "/left/points", "/left/camera_info", "/tf"} and all(len(of) == 2 for of in found.values())
    for place, (_, picture) in enumerate(pictures(drive)):
        fx, skew, cx, fy, cy = picture["camera_matrix_px"]
        for topic, of in found.items():
            time_ns, message = of[place]
            stamp = message.transforms[0].header.stamp if topic == "/tf" else message.header.stamp
            assert time_ns == stamp.sec * 10**9 + stamp.nanosec and abs(time_ns / 1e9 - picture["time_s"]) < 1e-9
        image, depth, info = (found[f"/left/{topic}"][place][1] for topic in ("image/compressed", "depth", "camera_info"))
        assert image.format == "png" and bytes(image.data)[:8] == b"\x89PNG\r\n\x1a\n" and image.header.frame_id == "left"
        assert (depth.width, depth.height, depth.encoding, depth.step) == (96, 60, "32FC1", 384)
        metres = np.frombuffer(bytes(depth.data), "<f4").reshape(60, 96)
        assert np.isinf(metres).any() and 1 < metres[-1, 48] < 20, "the sky, and the road before the car"
        assert info.distortion_model == "plumb_bob" and list(info.k) == [fx, skew, cx - 0.5, 0, fy, cy - 0.5, 0, 0, 1] and list(info.d) == [0] * 5
        cloud = found["/left/points"][place][1]
        assert [(field.name, field.offset, field.datatype, field.count) for field in cloud.fields] == [("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1), ("rgb", 12, 7, 1)]
        assert (cloud.width, cloud.height, cloud.point_step, cloud.row_step, cloud.is_dense, cloud.header.frame_id) == (96, 60, 16, 16 * 96, False, "left")
        points = np.frombuffer(bytes(cloud.data), [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4")]).reshape(60, 96)
        solid = np.isfinite(metres)
        assert (points["z"][solid] == metres[solid]).all() and np.isnan(points["x"][~solid]).all() and np.isnan(points["z"][~solid]).all()
        # By the message of the camera beside it, whose pixel centres are whole numbers.
        matrix = np.array(info.k).reshape(3, 3)
        rows, columns = np.nonzero(solid)
        projected = matrix @ np.stack([points[axis][solid].astype(float) for axis in "xyz"])
        assert np.allclose(projected[:2] / projected[2], [columns, rows], atol=1e-4)
        shown = np.asarray(Image.open(io.BytesIO(bytes(image.data))).convert("RGB")).astype(int)
        packed = np.stack([points["rgb"] >> shift & 255 for shift in (16, 8, 0)], axis=-1).astype(int)
        assert np.abs(packed - shown).max() <= 1, "the colours of the picture, to the last digit of its rounding"
        transform = found["/tf"][place][1].transforms[0]
        assert (transform.header.frame_id, transform.child_frame_id) == ("world", "left")
        at, turned = transform.transform.translation, transform.transform.rotation
        assert [at.x, at.y, at.z] == picture["pose"]["position_m"] and [turned.w, turned.x, turned.y, turned.z] == picture["pose"]["rotation_wxyz"]


@pytest.mark.parametrize("model", ["plumb_bob", "equidistant"])
def test_mcap_has_distorted_cameras(tmp_path, model):
    cv2 = pytest.importorskip("cv2")
    projection = {"plumb_bob": {"type": "opencv", "fx_px": 80, "distortion": [-0.2, 0.05, 0.001, -0.002]},
                  "equidistant": {"type": "kannala_brandt", "fx_px": 60, "fy_px": 61, "skew_px": 0.5, "k": [-0.02, 0.006, -0.004, 0.001]}}[model]
    changes = {"cameras.right": None, "cameras.rear": None, "cameras.left.output": None, "cameras.left.lens": {"type": "calibrated", "f_number": 4, "projection": projection}}
    sizes = {f"cameras.left.sensor.{key}": value for key, value in {"width_px": 96, "height_px": 60, "pixel_pitch_um": 60}.items()}
    etendue.dataset(ROOT / "scenes/drive/drive.toml", output=tmp_path / "set", frames=range(0, 1), spp=1, integrator="flat", set={**changes, **sizes}, format=["mcap"])
    (name,) = (tmp_path / "set/mcap/train").glob("*.mcap")
    topics = messages(name)
    ((_, info),), ((_, cloud),) = topics["/left/camera_info"], topics["/left/points"]
    assert info.distortion_model == model and list(info.d) == (projection["distortion"] + [0] if model == "plumb_bob" else projection["k"])
    points = np.frombuffer(bytes(cloud.data), [("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("rgb", "<u4")]).reshape(60, 96)
    rows, columns = np.nonzero(np.isfinite(points["z"]))
    assert len(rows) > 1000
    solid = np.stack([points[axis][rows, columns].astype(float) for axis in "xyz"], axis=-1)[:, None, :]
    matrix, zero = np.array(info.k).reshape(3, 3), np.zeros(3)
    if model == "plumb_bob":
        pixels, _ = cv2.projectPoints(solid, zero, zero, matrix, np.array(info.d))
    else:
        alpha, matrix[0, 1] = matrix[0, 1] / matrix[0, 0], 0
        pixels, _ = cv2.fisheye.projectPoints(solid, zero, zero, matrix, np.array(info.d), alpha=alpha)
    # Single-precision points of some 100 m: 1e-7 of 100 px, and some roundings.
    assert np.allclose(pixels.reshape(-1, 2), np.stack([columns, rows], axis=-1), atol=1e-4)


def test_openlabel_is_valid_by_the_standard_s_schema_and_has_our_boxes(drive, boxes):
    checker = pytest.importorskip("openlabel_checker.cli")
    for folder, count in ((drive, 1), (boxes, 2)):
        files = sorted((folder / "openlabel/train").glob("*.json"))
        assert len(files) == count
        assert [checker.main([str(name)]) for name in files] == [0] * count
    for sample, picture in pictures(drive):
        content = json.loads((drive / f"openlabel/train/{sample['sample']:06}.json").read_text())["openlabel"]
        frame = content["frames"][str(picture["frame"])]
        assert (drive / "openlabel/train" / frame["frame_properties"]["streams"]["left"]["uri"]).is_file()
        seen = {str(entry["id"]): entry for entry in picture["objects"] if entry["class"] and entry["mask_rle"]}
        assert set(frame["objects"]) == set(seen) and set(seen) <= set(content["objects"])
        for name, entry in seen.items():
            data = frame["objects"][name]["object_data"]
            x, y, width, height = data["bbox"][0]["val"]
            assert np.allclose([x - width / 2, y - height / 2, x + width / 2, y + height / 2], entry["visible_box_px"])
            assert data["cuboid"][0]["val"][:3] == entry["box_3d"]["world"]["centre_m"] and data["cuboid"][0]["val"][7:] == entry["box_3d"]["size_m"]
            assert content["objects"][name]["type"] == entry["class"]
        pose = np.array(frame["frame_properties"]["transforms"]["left_to_world"]["transform_src_to_dst"]["matrix4x4"]).reshape(4, 4)
        assert np.allclose(pose[:3, 3], picture["pose"]["position_m"]) and np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3))


def turned(yaw, pitch, roll):
    """A rotation about z, then the new y, then the new x (ISO 8855)."""
    about = lambda angle, i, j: np.eye(3) + (np.cos(angle) - 1) * (np.outer(np.eye(3)[i], np.eye(3)[i]) + np.outer(np.eye(3)[j], np.eye(3)[j])) + np.sin(angle) * (np.outer(np.eye(3)[j], np.eye(3)[i]) - np.outer(np.eye(3)[i], np.eye(3)[j]))
    return about(yaw, 0, 1) @ about(pitch, 2, 0) @ about(roll, 1, 2)


def of_quaternion(w, x, y, z):
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)], [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)], [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def test_osi_s_ground_truth_is_our_objects(drive):
    osi = pytest.importorskip("osi3trace.osi_trace")
    from osi3.osi_object_pb2 import MovingObject, StationaryObject

    (name,) = (drive / "osi/train").glob("*.osi")
    assert name.name == "19700101T000000Z_gt_380_6302_2_000000.osi"
    trace = osi.OSITrace(str(name), "GroundTruth")
    frames = list(trace)
    trace.close()
    assert len(frames) == 2 and all(frame.IsInitialized() for frame in frames)
    sizes = [frame.ByteSize() for frame in frames]
    for frame in frames:
        frame.DiscardUnknownFields()
    assert sizes == [frame.ByteSize() for frame in frames], "fields that the standard does not have"
    vehicles = {}
    for frame, (_, picture) in zip(frames, pictures(drive)):
        assert (frame.version.version_major, frame.version.version_minor, frame.version.version_patch) == (3, 8, 0)
        assert frame.timestamp.seconds + frame.timestamp.nanos / 1e9 == pytest.approx(picture["time_s"], abs=1e-9)
        objects = {of.id.value: of for of in [*frame.moving_object, *frame.stationary_object]}
        assert len(objects) == len(frame.moving_object) + len(frame.stationary_object), "identities are of one object each"
        seen = [entry for entry in picture["objects"] if entry["class"] and entry["class"] not in ("road", "sidewalk", "terrain", "parking", "marking")]
        assert len(seen) > 20 and {entry["id"] for entry in seen} <= set(objects) and len(objects) > len(seen), "also those that the camera does not see"
        assert not {entry["id"] for entry in picture["objects"] if entry["class"] == "road"} & set(objects)
        for entry in seen:
            of, stands = objects[entry["id"]], entry["box_3d"]["world"]
            base = of.base
            assert list(of.source_reference[0].identifier) == [entry["name"]]
            assert [base.dimension.length, base.dimension.width, base.dimension.height] == pytest.approx(entry["box_3d"]["size_m"])
            assert [base.position.x, base.position.y, base.position.z] == pytest.approx(stands["centre_m"])
            ours = of_quaternion(*stands["rotation_wxyz"])
            assert np.allclose(turned(base.orientation.yaw, base.orientation.pitch, base.orientation.roll), ours, atol=1e-9)
            # Corners by either rotation, so that swapped sizes or axes show.
            corner = np.array(entry["box_3d"]["size_m"]) / 2
            theirs = np.array([base.position.x, base.position.y, base.position.z]) + turned(base.orientation.yaw, base.orientation.pitch, base.orientation.roll) @ (np.array([base.dimension.length, base.dimension.width, base.dimension.height]) / 2)
            assert np.allclose(theirs, np.array(stands["centre_m"]) + ours @ corner, atol=1e-9)
            if entry["class"] == "car":
                assert of.type == MovingObject.TYPE_VEHICLE and of.vehicle_classification.type == MovingObject.VehicleClassification.TYPE_MEDIUM_CAR
            if entry["class"] == "building":
                assert of.classification.type == StationaryObject.Classification.TYPE_BUILDING
        for of in frame.moving_object:
            # People swing their limbs, and the middles of their boxes with them.
            if of.type == MovingObject.TYPE_VEHICLE:
                vehicles.setdefault(of.id.value, []).append(of.base)
    # Velocities against differences of places: over 50 ms a car on a smooth path keeps its velocity to a hundredth.
    span_s = frames[1].timestamp.nanos / 1e9 - frames[0].timestamp.nanos / 1e9
    moved = 0
    for before, after in vehicles.values():
        way = np.array([getattr(after.position, axis) - getattr(before.position, axis) for axis in "xyz"])
        mean = sum(np.array([getattr(base.velocity, axis) for axis in "xyz"]) for base in (before, after)) / 2
        assert np.allclose(way / span_s, mean, atol=0.001 + 0.01 * np.linalg.norm(mean))
        moved += np.linalg.norm(mean) > 1
    assert moved >= 2, "cars drive"
