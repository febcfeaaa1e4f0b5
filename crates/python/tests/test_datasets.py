"""Data sets, read by the formats' own readers: what these say is our truth."""

import io
import json
import tarfile

import numpy as np
import pytest
from conftest import ROOT
from PIL import Image

import etendue

FORMATS = ["coco", "kitti", "cityscapes", "yolo", "bop", "webdataset", "nuscenes"]
SIZE = {"width_px": 96, "height_px": 72, "pixel_pitch_um": 250}
SAMPLES, VARIATIONS = 4, ROOT / "scenes/datasets/boxes.toml"
CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])


def box_set():
    return {f"cameras.front.sensor.{key}": value for key, value in SIZE.items()}


@pytest.fixture(scope="module")
def boxes(tmp_path_factory):
    """Cornell boxes in all formats."""
    folder = tmp_path_factory.mktemp("boxes") / "set"
    written = etendue.dataset(
        ROOT / "scenes/cornell/cornell.toml", variations=VARIATIONS, output=folder, samples=range(0, SAMPLES), format=FORMATS, spp=2, set=box_set()
    )
    assert all(path.is_file() for path in written) and len(written) > 100
    return folder


@pytest.fixture(scope="module")
def drive(tmp_path_factory):
    """Two frames of the pair of the drive, whose cameras a car carries."""
    folder = tmp_path_factory.mktemp("drive") / "set"
    sizes = {"left": (96, 60, 60), "right": (48, 30, 120)}
    keys = ("width_px", "height_px", "pixel_pitch_um")
    changes = {f"cameras.{camera}.sensor.{key}": value for camera, values in sizes.items() for key, value in zip(keys, values, strict=True)}
    # A pair has pictures of one size.
    changes["cameras.left.output"] = None
    etendue.dataset(
        ROOT / "scenes/drive/drive.toml",
        variations=ROOT / "scenes/datasets/drive.toml",
        output=folder,
        frames=range(0, 2),
        spp=1,
        integrator="flat",
        set={**changes, "cameras.rear": None},
        format=["kitti", "nuscenes", "cityscapes"],
    )
    return folder


def records(folder):
    return [json.loads(path.read_text()) for path in sorted((folder / "samples").glob("*.json"))]


def truth(record):
    """The ground truth of a sample, by the library: another run, without the data set."""
    changes = dict(change.split("=", 1) for change in record["set"])
    job = etendue.Job.open(ROOT / "scenes/cornell/cornell.toml", spp=1, seed=record["seed"], set=[*(f"{k}={v}" for k, v in box_set().items()), *record["set"]])
    assert set(changes) >= {"scene.objects.short-block.material"}
    return job.render()["front"]


@pytest.fixture(scope="module")
def fronts(boxes):
    return [truth(record) for record in records(boxes)]


def pictures(folder):
    """Records of samples with their pictures."""
    return [(record, picture) for record in records(folder) for picture in record["pictures"]]


def test_coco_has_our_counts_boxes_and_masks(boxes, fronts):
    coco = pytest.importorskip("pycocotools.coco")
    evaluation = pytest.importorskip("pycocotools.cocoeval")
    seen = 0
    for split in ("train", "val"):
        found = coco.COCO(str(boxes / f"coco/annotations/instances_{split}.json"))
        for image in found.loadImgs(found.getImgIds()):
            front = fronts[int(image["file_name"][:6])]
            with Image.open(boxes / "coco" / split / image["file_name"]) as picture:
                assert picture.size == (image["width"], image["height"]) == (96, 72)
            annotations = found.loadAnns(found.getAnnIds(image["id"]))
            objects = [thing for thing in front.boxes["objects"] if thing["visible_pixels"] and thing["class"]]
            assert len(annotations) == len(objects)
            for annotation, thing in zip(annotations, objects, strict=True):
                left, top, right, bottom = thing["visible_box_px"]
                assert annotation["bbox"] == [left, top, right - left, bottom - top]
                mask = found.annToMask(annotation).astype(bool)
                assert np.array_equal(mask, front.instance_ids == thing["id"])
                assert annotation["area"] == mask.sum() == thing["visible_pixels"]
                assert np.all(front.semantic_ids[mask] == annotation["category_id"])
                assert found.loadCats(annotation["category_id"])[0]["name"] == thing["class"]
                seen += 1
        if not found.getImgIds():
            continue
        ours = [{**annotation, "score": 1.0} for annotation in found.loadAnns(found.getAnnIds())]
        results = found.loadRes(ours)
        for kind in ("bbox", "segm"):
            judged = evaluation.COCOeval(found, results, kind)
            (judged.evaluate(), judged.accumulate(), judged.summarize())
            assert judged.stats[0] == 1.0
    assert seen > 20


def test_kitti_s_boxes_in_space_are_within_those_of_the_picture(drive):
    utilities = pytest.importorskip("pykitti.utils")
    checked = 0
    for record, picture in pictures(drive):
        root = drive / "kitti" / picture["camera"] / "training"
        number = f"{record['sample'] * 2 + picture['frame']:06}"
        found = utilities.read_calib_file(root / "calib" / f"{number}.txt")
        p2 = found["P2"].reshape(3, 4)
        fx, skew, cx, fy, cy = picture["camera_matrix_px"]
        assert np.allclose(p2, [[fx, skew, cx - 0.5, 0], [0, fy, cy - 0.5, 0], [0, 0, 1, 0]], rtol=1e-11)
        objects = [thing for thing in picture["objects"] if thing["mask_rle"] and thing["class"] in ("car", "person")]
        lines = (root / "label_2" / f"{number}.txt").read_text().splitlines()
        assert len(lines) == len(objects)
        for line, thing in zip(lines, objects, strict=True):
            kind, *numbers = line.split()
            assert kind == {"car": "Car", "person": "Pedestrian"}[thing["class"]]
            truncated, occluded, alpha, *box, h, w, l, x, y, z, turn = map(float, numbers)
            assert len(numbers) == 14 and occluded in (0, 1, 2) and -np.pi <= alpha <= np.pi
            about = np.array([[np.cos(turn), 0, np.sin(turn)], [0, 1, 0], [-np.sin(turn), 0, np.cos(turn)]])
            corners = CORNERS * [l, h, w] @ about.T + [x, y - h / 2, z]
            # The upright box holds the object's own.
            solid = thing["box_3d"]
            inner = CORNERS * solid["size_m"] @ rotation(solid["camera"]["rotation_wxyz"]).T + solid["camera"]["centre_m"]
            within = (inner - [x, y - h / 2, z]) @ about
            assert np.all(np.abs(within) <= np.array([l, h, w]) / 2 + 1e-5)
            if truncated == 0 and not thing["is_cut"]:
                image = np.column_stack([corners, np.ones(8)]) @ p2.T
                image = image[:, :2] / image[:, 2:]
                # A car is smaller than its box, and turned by less than a degree against the camera's y.
                assert np.all(image.min(0) <= np.array(box[:2]) + 1) and np.all(image.max(0) >= np.array(box[2:]) - 1)
                checked += 1
    assert checked > 5


def rotation(wxyz):
    w, x, y, z = wxyz
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def test_cityscapes_labels_are_our_classes(boxes, fronts):
    labels = {"wall": 12, "block": 11, "lamp": 19}
    for record, front in zip(records(boxes), fronts, strict=True):
        stem = boxes / f"cityscapes/gtFine/{record['split']}/front/front_{record['sample']:06}_000000_gtFine"
        ids, instances = (np.array(Image.open(f"{stem}_{kind}.png")) for kind in ("labelIds", "instanceIds"))
        assert ids.dtype == np.uint8 and instances.max() <= 23
        expected = np.where(np.isinf(front.distance), 23, 0)
        for name, label in labels.items():
            expected[front.semantic_ids == {"wall": 1, "block": 2, "lamp": 3}[name]] = label
        assert np.array_equal(ids, expected) and np.array_equal(instances, expected)


def test_cityscapes_own_script_counts_the_objects_that_we_count(drive):
    script = pytest.importorskip("cityscapesscripts.evaluation.instances2dict")
    (record,) = records(drive)
    for picture in record["pictures"]:
        camera = picture["camera"]
        name = drive / f"cityscapes/gtFine/train/{camera}/{camera}_000000_{picture['frame']:06}_gtFine_instanceIds.png"
        (found,) = script.instances2dict([str(name)], False).values()
        for kind in ("car", "person"):
            ours = sorted(thing["visible_pixels"] for thing in picture["objects"] if thing["class"] == kind and thing["mask_rle"])
            assert sorted(thing["pixelCount"] for thing in found[kind]) == ours and ours


def test_yolo_s_boxes_are_ours(boxes):
    yaml = pytest.importorskip("yaml")
    data = yaml.safe_load((boxes / "yolo/data.yaml").read_text())
    assert data["names"] == {0: "wall", 1: "block", 2: "lamp"}
    for record, picture in pictures(boxes):
        stem = f"{record['sample']:06}_front_0000"
        assert (boxes / f"yolo/images/{record['split']}/{stem}.png").is_file()
        lines = (boxes / f"yolo/labels/{record['split']}/{stem}.txt").read_text().splitlines()
        found = [[float(word) for word in line.split()] for line in lines]
        expected = [thing for thing in picture["objects"] if thing["visible_box_px"]]
        assert len(found) == len(expected) > 5
        for (place, x, y, w, h), thing in zip(found, expected, strict=True):
            box = np.array([x - w / 2, y - h / 2, x + w / 2, y + h / 2]) * [96, 72, 96, 72]
            assert data["names"][int(place)] == thing["class"] and np.allclose(box, thing["visible_box_px"], atol=1e-6)


def test_bop_has_our_depth_masks_and_poses(boxes, fronts):
    models = json.loads((boxes / "bop/models/models_info.json").read_text())
    for record, front in zip(records(boxes), fronts, strict=True):
        scene = boxes / f"bop/{record['split']}/{record['sample']:06}"
        camera, poses, counts = (json.loads((scene / f"scene_{name}.json").read_text())["0"] for name in ("camera", "gt", "gt_info"))
        depth = np.array(Image.open(scene / "depth/000000.png")) * camera["depth_scale"]
        known = np.isfinite(front.depth)
        assert np.allclose(depth[known], 1000 * front.depth[known], atol=0.501) and not depth[~known].any()
        matrix = np.array(camera["cam_K"]).reshape(3, 3)
        objects = [thing for thing in front.boxes["objects"] if thing["class"]]
        assert len(poses) == len(counts) == len(objects) > 5
        for place, (pose, count, thing) in enumerate(zip(poses, counts, objects, strict=True)):
            whole, seen = (np.array(Image.open(scene / kind / f"000000_{place:06}.png")) == 255 for kind in ("mask", "mask_visib"))
            assert pose["obj_id"] == thing["id"] and np.array_equal(seen, front.instance_ids == thing["id"])
            assert np.all(whole[seen]) and count["px_count_visib"] == seen.sum() == thing["visible_pixels"]
            assert count["px_count_all"] == whole.sum() == max(thing["alone_pixels"], thing["visible_pixels"])
            assert count["px_count_valid"] == (whole & (depth > 0)).sum()
            if not thing["is_cut"] and thing["truncated_fraction"] == 0:
                box = models[str(pose["obj_id"])]
                size = np.array([box["size_x"], box["size_y"], box["size_z"]])
                corners = CORNERS * size @ np.array(pose["cam_R_m2c"]).reshape(3, 3).T + pose["cam_t_m2c"]
                image = corners @ matrix.T
                image = image[:, :2] / image[:, 2:] + 0.5
                left, top, right, bottom = thing["amodal_box_px"]
                # Boxes are boxes: their corners bound the image, which pixel centres know to half a pixel.
                assert np.allclose([*image.min(0), *image.max(0)], [left, top, right, bottom], atol=0.51)


def test_webdataset_s_shards_hold_the_pictures_with_their_truth(boxes, fronts):
    found = {}
    for shard in sorted((boxes / "webdataset").glob("*-000000.tar")):
        with tarfile.open(shard) as archive:
            assert all(member.isfile() and member.mtime == 0 for member in archive.getmembers())
        reader = pytest.importorskip("webdataset")
        for sample in reader.WebDataset(str(shard), shardshuffle=False):
            found[sample["__key__"]] = sample
    assert sorted(found) == [f"{number:06}_front_0000" for number in range(SAMPLES)]
    for record, front in zip(records(boxes), fronts, strict=True):
        sample = found[f"{record['sample']:06}_front_0000"]
        assert json.loads(sample["json"]) == {"sample": record["sample"], "picture": record["pictures"][0]}
        assert np.array_equal(np.array(Image.open(io.BytesIO(sample["instance.png"]))), front.instance_ids)
        assert np.array_equal(np.load(io.BytesIO(sample["depth.npy"])), front.depth)
        coco = boxes / f"coco/{record['split']}/{sample['__key__']}.png"
        assert sample["png"] == coco.read_bytes()


def test_nuscenes_places_boxes_where_our_truth_has_them(drive):
    nuscenes = pytest.importorskip("nuscenes.nuscenes")
    found = nuscenes.NuScenes(version="v1.0-train", dataroot=str(drive / "nuscenes"), verbose=False)
    (record,) = records(drive)
    assert len(found.scene) == 1 and len(found.sample) == 2 and len(found.sample_data) == 4
    checked = 0
    for picture in record["pictures"]:
        sample = found.sample[picture["frame"]]
        path, boxes, matrix = found.get_sample_data(sample["data"][picture["camera"]], box_vis_level=0)
        assert (drive / "nuscenes").joinpath("samples") in __import__("pathlib").Path(path).parents
        fx, skew, cx, fy, cy = picture["camera_matrix_px"]
        assert np.allclose(matrix, [[fx, skew, cx - 0.5], [0, fy, cy - 0.5], [0, 0, 1]])
        objects = {thing["name"]: thing for thing in picture["objects"]}
        by_id = {thing["id"]: thing for thing in objects.values() if thing["mask_rle"] and thing["class"]}
        for box in boxes:
            annotation = found.get("sample_annotation", box.token)
            thing = by_id.get(int(annotation["instance_token"][16:24], 16))
            if thing is None or picture["camera"] != "left":
                continue
            assert box.name == thing["class"] and np.allclose(box.center, thing["box_3d"]["camera"]["centre_m"], atol=1e-6)
            w, l, h = box.wlh
            assert np.allclose([l, w, h], thing["box_3d"]["size_m"])
            assert np.allclose(np.abs(box.rotation_matrix - rotation(thing["box_3d"]["camera"]["rotation_wxyz"])), 0, atol=1e-9)
            checked += 1
    assert checked > 5


def test_a_stereo_matcher_runs_on_kitti_s_folders_as_they_are(tmp_path):
    cv2 = pytest.importorskip("cv2")
    utilities = pytest.importorskip("pykitti.utils")
    room = ROOT / "tests/oracles/figures/reconstruction/room.toml"
    etendue.dataset(room, output=tmp_path / "set", format=["kitti", "webdataset"], spp=8)
    root = tmp_path / "set/kitti/left/training"
    left, right = (cv2.imread(str(root / f"image_{camera}/000000.png"), cv2.IMREAD_GRAYSCALE) for camera in (2, 3))
    found = utilities.read_calib_file(root / "calib/000000.txt")
    p2, p3 = found["P2"].reshape(3, 4), found["P3"].reshape(3, 4)
    matcher = cv2.StereoSGBM.create(numDisparities=32, blockSize=5, P1=200, P2=800, uniquenessRatio=5, speckleWindowSize=50, speckleRange=2)
    disparity = matcher.compute(left, right) / 16
    with tarfile.open(tmp_path / "set/webdataset/train-000000.tar") as archive:
        depth = np.load(io.BytesIO(archive.extractfile("000000_left_0000.depth.npy").read()))
    known = (disparity > 0) & np.isfinite(depth)
    off = disparity[known] - (p2[0, 3] - p3[0, 3]) / depth[known]
    # Semi-global matching is right to about a tenth of a pixel (docs/ground-truth.md); half a pixel would be beyond it.
    assert known.mean() > 0.6 and abs(np.median(off)) < 0.1 and np.median(np.abs(off)) < 0.25
