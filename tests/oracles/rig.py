"""Calibration files of a rig, read by other programs: figures/rig.json, figures/rig/calibration.

The binary writes the files of figures/rig/rig.toml over three frames (a test holds them to the byte). What they say of points of the world:

- ROS: PyYAML reads camera_info and the transforms, cv2.projectPoints and cv2.fisheye.projectPoints see points of the car's frame;
  P of the right camera sees points of the left camera's frame.
- Kalibr: PyYAML reads the chain, numpy goes along T_cam_imu and T_cn_cnm1, OpenCV projects.
- COLMAP: pycolmap.Reconstruction reads the model and projects points of the world into every image.

Pixels are raster coordinates: OpenCV's plus 0.5, COLMAP's as they are. Versions: requirements.txt. Needs the binary; without an
argument it is built:
    python tests/oracles/rig.py [BINARY]
"""

import json
import pathlib
import shutil
import subprocess
import sys

import cv2
import numpy as np
import pycolmap
import yaml

ROOT = pathlib.Path(__file__).parent
FIGURES = ROOT / "figures"
FILES = FIGURES / "rig" / "calibration"
NAMES = ("left", "right", "side", "five", "rear")
ZERO = np.zeros(3)


def binary():
    if len(sys.argv) > 1:
        return sys.argv[1]
    root = ROOT.parent.parent
    subprocess.run(["cargo", "build", "--release", "-p", "etendue-cli"], cwd=root, check=True)
    return str(root / "target" / "release" / "etendue")


def write():
    shutil.rmtree(FILES, ignore_errors=True)
    job, out = FIGURES / "rig" / "rig.toml", FIGURES / "rig"
    subprocess.run([binary(), "rig", str(job), "-o", str(out), "--frames", "0..3"], check=True)


def turned(q):
    """The rotation of a quaternion w, x, y, z."""
    w, x, y, z = q
    angle, axis = 2.0 * np.arctan2(np.linalg.norm([x, y, z]), w), np.array([x, y, z])
    length = np.linalg.norm(axis)
    return cv2.Rodrigues(axis / length * angle if length > 0.0 else ZERO)[0]


def seen(points, k, model, d):
    """Raster pixels of points of the camera's frame."""
    if model == "equidistant":
        pixels, _ = cv2.fisheye.projectPoints(points[:, None, :], ZERO, ZERO, k, np.array(d))
    else:
        pixels, _ = cv2.projectPoints(points, ZERO, ZERO, k, np.array(d))
    return pixels.reshape(-1, 2) + 0.5


def ahead(rng, count=12):
    """Points before a camera, in its frame."""
    z = rng.uniform(2.0, 20.0, count)
    return np.column_stack([rng.uniform(-0.5, 0.5, count) * z, rng.uniform(-0.4, 0.4, count) * z, z])


def ros(rng):
    found = {}
    transforms = yaml.safe_load((FILES / "ros" / "static_transforms.yaml").read_text())["transforms"]
    for name in NAMES:
        info = yaml.safe_load((FILES / "ros" / f"{name}.yaml").read_text())
        k = np.array(info["camera_matrix"]["data"]).reshape(3, 3)
        t = next(t for t in transforms if t["child_frame_id"] == f"{name}_optical_frame")
        q, shift = t["transform"]["rotation"], t["transform"]["translation"]
        rotation = turned([q["w"], q["x"], q["y"], q["z"]])
        place = np.array([shift["x"], shift["y"], shift["z"]])
        points = ahead(rng) @ rotation.T + place
        pixels = seen((points - place) @ rotation, k, info["distortion_model"], info["distortion_coefficients"]["data"])
        found[name] = {"frame": t["header"]["frame_id"], "points_m": points.tolist(), "pixels": pixels.tolist()}
    right = yaml.safe_load((FILES / "ros" / "right.yaml").read_text())
    p = np.array(right["projection_matrix"]["data"]).reshape(3, 4)
    points = ahead(rng)
    image = np.column_stack([points, np.ones(len(points))]) @ p.T
    found["pair"] = {"points_m": points.tolist(), "pixels": (image[:, :2] / image[:, 2:] + 0.5).tolist()}
    return found


def kalibr(rng):
    chain = yaml.safe_load((FILES / "kalibr" / "camchain-left.yaml").read_text())
    found, before = {}, None
    for key in sorted(chain):
        camera = chain[key]
        name = camera["rostopic"].split("/")[1]
        from_car = np.array(camera["T_cam_imu"])
        fu, fv, pu, pv = camera["intrinsics"]
        k = np.array([[fu, 0.0, pu], [0.0, fv, pv], [0.0, 0.0, 1.0]])
        inside = ahead(rng)
        points = (inside - from_car[:3, 3]) @ from_car[:3, :3]
        along = from_car if before is None else np.array(camera["T_cn_cnm1"]) @ before
        there = points @ along[:3, :3].T + along[:3, 3]
        pixels = seen(there, k, camera["distortion_model"], camera["distortion_coeffs"])
        found[name] = {"points_m": points.tolist(), "pixels": pixels.tolist()}
        before = from_car
    return found


def colmap(rng):
    model = pycolmap.Reconstruction(str(FILES / "colmap"))
    found = []
    for _, image in sorted(model.images.items()):
        camera, pose = model.cameras[image.camera_id], image.cam_from_world()
        points = np.array([pose.inverse() * p for p in ahead(rng, 4)])
        pixels = [camera.img_from_cam((pose * p)[None, :])[0] for p in points]
        found.append({"name": image.name, "model": camera.model.name, "points_m": points.tolist(),
                      "pixels": np.array(pixels).tolist()})
    return found


def main():
    write()
    rng = np.random.default_rng(20250217)
    figures = {"programs": [f"OpenCV {cv2.__version__}", f"pycolmap {pycolmap.__version__}", f"PyYAML {yaml.__version__}"],
               "ros": ros(rng), "kalibr": kalibr(rng), "colmap": colmap(rng)}
    (FIGURES / "rig.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
