"""Figures of OpenCV for crates/metrology: figures/checkerboard/opencv.json.

Corners (cv2.findChessboardCorners, cv2.cornerSubPix) of OpenCV's own sample photographs left01.jpg ... left14.jpg, 9 x 6
inner corners, and the camera that cv2.calibrateCameraExtended finds from them, with its standard deviations: k1 k2 p1 p2 k3.
Pixel centres at whole numbers. Versions: requirements.txt. They are
stored here, as they are in OpenCV's samples/data and in Debian's opencv-doc:
    ETENDUE_OPENCV_SAMPLES=opencv/samples/data python tests/oracles/checkerboard.py
"""

import json
import os
import pathlib

import cv2
import numpy as np

FOLDER = os.environ.get("ETENDUE_OPENCV_SAMPLES")
FIGURES = pathlib.Path(__file__).parent / "figures" / "checkerboard"
SIZE = (9, 6)


def corners(name):
    grey = cv2.imread(str(pathlib.Path(FOLDER) / name), cv2.IMREAD_GRAYSCALE)
    found, rough = cv2.findChessboardCorners(grey, SIZE)
    assert found, name
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-6)
    return cv2.cornerSubPix(grey, rough.astype(np.float32), (5, 5), (-1, -1), criteria).reshape(-1, 2)


def main():
    if not FOLDER:
        print("ETENDUE_OPENCV_SAMPLES is not set: left out")
        return
    names = [f"left{i:02}.jpg" for i in range(1, 15) if i != 10]
    seen = [corners(name) for name in names]
    seen = [np.round(points.astype(np.float64), 4) for points in seen]
    board = np.array([[x, y, 0.0] for y in range(SIZE[1]) for x in range(SIZE[0])], np.float32)
    many = [board] * len(seen)
    views = [points.astype(np.float32) for points in seen]
    rms, matrix, distortion, _, _, deviations, _, per_view = cv2.calibrateCameraExtended(
        many, views, (640, 480), None, None
    )
    deviations = deviations.ravel()
    names_of = ["fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"]
    values = [matrix[0, 0], matrix[1, 1], matrix[0, 2], matrix[1, 2], *distortion.ravel()[:5]]
    figures = {
        "opencv": cv2.__version__,
        "convention": "pixel centres at whole numbers",
        "size": SIZE,
        "width_px": 640,
        "height_px": 480,
        "views": {name: points.tolist() for name, points in zip(names, seen)},
        "camera": {
            name: {"value": float(v), "standard_deviation": float(s)}
            for name, v, s in zip(names_of, values, deviations)
        },
        "rms_px": rms,
        "view_rms_px": [float(v) for v in per_view.ravel()],
    }
    FIGURES.joinpath("opencv.json").write_text(json.dumps(figures, separators=(",", ":")) + "\n")
    print(rms, figures["camera"])


main()
