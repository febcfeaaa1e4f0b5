"""Figures of OpenCV and COLMAP for crates/projection and crates/io: figures/cameras.json, figures/calibrations.

cv2.projectPoints with 4 to 14 coefficients, cv2.fisheye and cv2.omnidir (pixel centres at whole numbers), and every camera
model of COLMAP (pixel centres at + 0.5). The calibration files are those programs' own writing. Versions:
requirements.txt. Run anywhere:
    python tests/oracles/cameras.py
"""

import json
import pathlib

import cv2
import numpy as np
import pycolmap

ROOT = pathlib.Path(__file__).parent
FILES = ROOT / "figures" / "calibrations"
MATRIX = [[812.5, 0.0, 319.25], [0.0, 798.0, 241.5], [0.0, 0.0, 1.0]]
SKEWED = [[412.5, 0.8, 319.25], [0.0, 408.0, 241.5], [0.0, 0.0, 1.0]]
PERSPECTIVE = [
    [],
    [-0.28, 0.07, 0.0011, -0.0008],
    [-0.31, 0.12, -0.0004, 0.0007, -0.02],
    [0.4, -0.25, 0.0009, 0.0002, 0.03, 0.72, -0.19, 0.01],
    [-0.2, 0.05, 0.0011, -0.0008, 0.01, 0.02, -0.005, 0.001, 0.002, -0.001, 0.0015, 0.0004],
    [-0.2, 0.05, 0.0011, -0.0008, 0.01, 0.02, -0.005, 0.001, 0.002, -0.001, 0.0015, 0.0004, 0.06, -0.11],
]
FISHEYE = [[0.0, 0.0, 0.0, 0.0], [-0.012, 0.0042, -0.0031, 0.0006], [0.05, -0.02, 0.004, -0.0008]]
MEI = [(0.8, [-0.1, 0.02, 0.0007, -0.0003]), (1.6, [-0.21, 0.09, 0.0002, 0.0004]), (0.0, [0.0, 0.0, 0.0, 0.0])]
COLMAP = {
    "SIMPLE_PINHOLE": [500.0, 319.5, 241.0],
    "PINHOLE": [500.0, 505.0, 319.5, 241.0],
    "SIMPLE_RADIAL": [500.0, 319.5, 241.0, -0.08],
    "SIMPLE_RADIAL_FISHEYE": [250.0, 319.5, 241.0, -0.02],
    "RADIAL": [500.0, 319.5, 241.0, -0.12, 0.03],
    "RADIAL_FISHEYE": [250.0, 319.5, 241.0, -0.03, 0.004],
    "OPENCV": [500.0, 505.0, 319.5, 241.0, -0.12, 0.03, 0.0011, -0.0006],
    "OPENCV_FISHEYE": [250.0, 252.0, 319.5, 241.0, -0.012, 0.0042, -0.0031, 0.0006],
    "FULL_OPENCV": [500.0, 505.0, 319.5, 241.0, 0.4, -0.25, 0.0009, 0.0002, 0.03, 0.72, -0.19, 0.01],
    "FOV": [300.0, 302.0, 319.5, 241.0, 0.93],
    "THIN_PRISM_FISHEYE": [250.0, 252.0, 319.5, 241.0, -0.012, 0.004, 0.0007, -0.0003, -0.002, 0.0003, 0.0011, -0.0009],
    "RAD_TAN_THIN_PRISM_FISHEYE": [250.0, 252.0, 319.5, 241.0, -0.012, 0.004, -0.002, 0.0006, -0.0002, 0.00002,
                                   0.0007, -0.0003, 0.0011, -0.0009, 0.0002, -0.0001],
    "SIMPLE_DIVISION": [500.0, 319.5, 241.0, -0.15],
    "DIVISION": [500.0, 505.0, 319.5, 241.0, -0.15],
    "SIMPLE_FISHEYE": [250.0, 319.5, 241.0],
    "FISHEYE": [250.0, 252.0, 319.5, 241.0],
    "EUCM": [300.0, 302.0, 319.5, 241.0, 0.62, 1.1],
    "EQUIRECTANGULAR": [640.0, 480.0],
}


def points(rng, count, greatest_deg):
    """Points on rays up to a field angle, at 0.5 to 20 m."""
    angle = np.radians(greatest_deg) * np.sqrt(rng.uniform(0.0, 1.0, count))
    azimuth = rng.uniform(0.0, 2.0 * np.pi, count)
    rays = np.column_stack([np.sin(angle) * np.cos(azimuth), np.sin(angle) * np.sin(azimuth), np.cos(angle)])
    return rays * rng.uniform(0.5, 20.0, count)[:, None]


def table(world, pixels):
    return {"points_m": world.tolist(), "pixels": np.asarray(pixels).reshape(-1, 2).tolist()}


def opencv(rng):
    zero, world = np.zeros(3), points(rng, 40, 30.0)
    perspective = []
    for c in PERSPECTIVE:
        pixels, _ = cv2.projectPoints(world, zero, zero, np.array(MATRIX), np.array(c) if c else None)
        perspective.append({"coefficients": c} | table(world, pixels))
    wide, fisheye = points(rng, 40, 80.0), []
    for c in FISHEYE:
        k = np.array(SKEWED)
        alpha, k[0, 1] = k[0, 1] / k[0, 0], 0.0
        pixels, _ = cv2.fisheye.projectPoints(wide[:, None, :], zero, zero, k, np.array(c), alpha=alpha)
        fisheye.append({"coefficients": c} | table(wide, pixels))
    mei = []
    for xi, c in MEI:
        world = points(rng, 40, 75.0 if xi == 0.0 else 110.0)
        pixels, _ = cv2.omnidir.projectPoints(world[:, None, :], zero, zero, np.array(SKEWED), xi, np.array([c]))
        mei.append({"xi": xi, "coefficients": c} | table(world, pixels))
    return {"perspective": perspective, "fisheye": fisheye, "mei": mei, "matrix": MATRIX, "skewed": SKEWED}


def colmap(rng):
    cameras = []
    for name, parameters in COLMAP.items():
        greatest = 175.0 if name == "EQUIRECTANGULAR" else 75.0 if "FISHEYE" in name else 45.0
        world = points(rng, 40, greatest)
        camera = pycolmap.Camera(model=name, width=640, height=480, params=parameters)
        pixels = np.array([camera.img_from_cam(p[None, :])[0] for p in world])
        cameras.append({"model": name, "parameters": parameters} | table(world, pixels))
    return cameras


def file_storage(name, matrix, coefficients, **more):
    """A calibration as OpenCV's own programs write it."""
    storage = cv2.FileStorage(str(FILES / name), cv2.FILE_STORAGE_WRITE)
    storage.write("image_width", 640)
    storage.write("image_height", 480)
    for key, value in more.items():
        storage.write(key, value)
    storage.write("camera_matrix", np.array(matrix))
    storage.write("distortion_coefficients", np.array([coefficients]).T)
    storage.write("avg_reprojection_error", 0.125)
    storage.release()


def files(cameras):
    FILES.mkdir(exist_ok=True)
    file_storage("opencv.yml", MATRIX, PERSPECTIVE[5])
    file_storage("opencv.json", MATRIX, PERSPECTIVE[3])
    file_storage("opencv_fisheye.yml", SKEWED, FISHEYE[1], fisheye_model=1)
    file_storage("opencv_omnidir.yml", SKEWED, MEI[0][1], xi=np.array([[MEI[0][0]]]))
    made = pycolmap.Reconstruction()
    for i, camera in enumerate(cameras):
        made.add_camera(pycolmap.Camera(model=camera["model"], width=640, height=480, params=camera["parameters"],
                                        camera_id=i + 1))
    made.write_text(str(FILES))
    for path in FILES.glob("*.txt"):
        if path.name != "cameras.txt":
            path.unlink()


def main():
    rng = np.random.default_rng(20240612)
    opencv_figures, colmap_figures = opencv(rng), colmap(rng)
    files(colmap_figures)
    figures = {"programs": [f"opencv-contrib-python-headless {cv2.__version__}", f"pycolmap {pycolmap.__version__}"],
               "opencv": opencv_figures, "colmap": colmap_figures}
    (ROOT / "figures" / "cameras.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
