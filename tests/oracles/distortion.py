"""Figures of OpenCV for crates/projection: figures/distortion.json.

cv2.projectPoints with k1, k2 alone is the radial polynomial from ideal to observed with the radius in focal lengths, and pixel
centres at whole numbers. Versions: requirements.txt. Run anywhere:
    python tests/oracles/distortion.py
"""

import json
import pathlib

import cv2
import numpy as np

MATRIX = [[812.5, 0.0, 319.25], [0.0, 798.0, 241.5], [0.0, 0.0, 1.0]]
LENSES = [(0.0, 0.0), (-0.28, 0.07), (-0.1, 0.0), (0.12, -0.01), (0.05, 0.03)]


def project(k1, k2, points):
    pixels, _ = cv2.projectPoints(points, np.zeros(3), np.zeros(3), np.array(MATRIX), np.array([k1, k2, 0.0, 0.0]))
    return pixels.reshape(-1, 2)


def main():
    rng = np.random.default_rng(20240611)
    tangents = rng.uniform(-0.45, 0.45, (40, 2))
    depth = rng.uniform(0.5, 20.0, 40)
    points = np.column_stack([tangents * depth[:, None], depth])
    lenses = [{"k1": k1, "k2": k2, "pixels": project(k1, k2, points).tolist()} for k1, k2 in LENSES]
    figures = {"program": f"opencv-contrib-python-headless {cv2.__version__}", "matrix": MATRIX, "points_m": points.tolist(), "lenses": lenses}
    path = pathlib.Path(__file__).parent / "figures" / "distortion.json"
    path.write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
