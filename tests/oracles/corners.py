"""How well OpenCV finds corners under the conditions of its own photographs: figures/checkerboard/corners.json.

For each of OpenCV's photographs left01.jpg ... left14.jpg a picture is drawn in closed form of the same board, seen by the
camera and in the pose that figures/checkerboard/opencv.json and cv2.calibrateCamera say, with the photograph's own grey levels
(quadratic over the board), its blur (Gaussian along columns and rows, and the width by which dark squares are narrower or wider
than light ones: least squares over the edges), its noise (so that even squares scatter as the photograph's do after
compression) and its JPEG tables. The corners' true places in it are known; cv2.findChessboardCorners and cv2.cornerSubPix, as in
checkerboard.py, are judged by them. REPEATS noises of each. What the photographs have besides (texture of the print, edges that
are not straight) is missing: OpenCV's scatter on the photographs themselves is rather larger.

Two of the pictures are stored, with the corners' places, for our own corners to be judged in the same way.
Pixel centres at whole numbers. Versions: requirements.txt. Where the photographs are: checkerboard.py.
    ETENDUE_OPENCV_SAMPLES=opencv/samples/data python tests/oracles/corners.py
"""

import io
import json
import os
import pathlib

import cv2
import numpy as np
from PIL import Image
from scipy.ndimage import gaussian_filter, map_coordinates

FOLDER = os.environ.get("ETENDUE_OPENCV_SAMPLES")
FIGURES = pathlib.Path(__file__).parent / "figures" / "checkerboard"
FINE = 6
REPEATS = 4
STORED = ["left05.jpg", "left14.jpg"]
WIDTH, HEIGHT = 640, 480
BOARD = np.array([[x, y, 0.0] for y in range(6) for x in range(9)])


def corners(grey):
    found, rough = cv2.findChessboardCorners(grey, (9, 6))
    assert found
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-6)
    found = cv2.cornerSubPix(grey, rough.astype(np.float32), (5, 5), (-1, -1), criteria)
    return found.reshape(-1, 2).astype(float)


def undistorted(places, d):
    """By fixed-point iteration, which the photographs' mild distortion allows."""
    k1, k2, p1, p2, k3 = d
    at = places.copy()
    for _ in range(40):
        x, y = at.T
        r2 = x * x + y * y
        scale = 1 + r2 * (k1 + r2 * (k2 + r2 * k3))
        tangential = np.stack([2 * p1 * x * y + p2 * (r2 + 2 * x * x), p1 * (r2 + 2 * y * y) + 2 * p2 * x * y], -1)
        at = (places - tangential) / scale[:, None]
    return at


def board_places(matrix, d, turn, place):
    """The board's coordinates at the middles of FINE x FINE parts of every pixel."""
    x, y = np.meshgrid(np.arange(WIDTH + 1) - 0.5, np.arange(HEIGHT + 1) - 0.5)
    normal = np.stack([(x - matrix[0, 2]) / matrix[0, 0], (y - matrix[1, 2]) / matrix[1, 1]], -1).reshape(-1, 2)
    rotation, _ = cv2.Rodrigues(turn)
    to_board = np.linalg.inv(np.column_stack([rotation[:, 0], rotation[:, 1], place.ravel()]))
    q = to_board @ np.vstack([undistorted(normal, d).T, np.ones(x.size)])
    at_corners = (q[:2] / q[2]).reshape(2, HEIGHT + 1, WIDTH + 1)
    middles = [(np.arange(n * FINE) + 0.5) / FINE for n in (HEIGHT, WIDTH)]
    grid = np.meshgrid(*middles, indexing="ij")
    return [map_coordinates(part, grid, order=3) for part in at_corners]


def pixels(fine):
    return fine.reshape(HEIGHT, FINE, WIDTH, FINE).mean((1, 3))


def to_line(u):
    """Distance from the nearest line of whole u, in parts of pixels."""
    down, across = np.gradient(u)
    return (np.abs(u - np.round(u)) / np.hypot(across, down)).astype(np.float32)


def even(grey, mask):
    """A quadratic through masked pixels, and how far these scatter about it."""
    terms = lambda x, y: np.stack([(x / 320 - 1) ** i * (y / 240 - 1) ** j for i in range(3) for j in range(3 - i)], -1)
    y, x = np.nonzero(mask)
    solved, *_ = np.linalg.lstsq(terms(x, y), grey[y, x], rcond=None)
    rows, columns = np.mgrid[0:HEIGHT, 0:WIDTH]
    return terms(columns, rows) @ solved, (grey[y, x] - terms(x, y) @ solved).std()


class Board:
    """What a photograph shows of the board."""

    def __init__(self, grey, u, v):
        self.grey, self.to_u, self.to_v = grey, to_line(u), to_line(v)
        # The outer columns are half as wide.
        self.inside = (u > -0.45) & (v > -0.95) & (u < 8.45) & (v < 5.95)
        core = pixels(((u > -0.35) & (v > -0.6) & (u < 8.35) & (v < 5.6)).astype(np.float32)) > 0.999
        self.dark = (np.floor(u) + np.floor(v)) % 2 == 0
        share = [pixels((part & self.inside).astype(np.float32)) for part in (self.dark, ~self.dark)]
        if grey[(share[0] > 0.99) & core].mean() > grey[(share[1] > 0.99) & core].mean():
            self.dark, share = ~self.dark, share[::-1]
        shrunk = lambda mask: cv2.erode(mask.astype(np.uint8), np.ones((9, 9))) > 0
        self.even = [shrunk((part > 0.999) & core) for part in share]
        (self.low, low), (self.high, high) = (even(grey, mask) for mask in self.even)
        self.noise = np.array([low, high])
        self.edges = (cv2.dilate((np.abs(share[0] - 0.5) < 0.49).astype(np.uint8), np.ones((7, 7))) > 0) & core

    def light(self, across, down, narrower):
        """The share of the light squares' level: blur, px, and by how much dark squares are narrower on each side, px."""
        rim = max(abs(narrower) * FINE, 0.5)
        inner = np.clip(self.to_u - rim + 0.5, 0, 1) * np.clip(self.to_v - rim + 0.5, 0, 1)
        chart = np.where(self.dark, 1 - inner, 1.0) if narrower >= 0 else np.where(self.dark, 0.0, inner)
        chart = np.where(self.inside, chart, 1.0).astype(np.float32)
        return pixels(gaussian_filter(chart, (down * FINE, across * FINE)))

    def picture(self, light):
        return self.low + (self.high - self.low) * light

    def fitted(self):
        """Blur and width, by steps of one number after the other."""
        at, steps = [0.8, 0.8, 0.1], [0.2, 0.2, 0.15]
        cost = lambda p: ((self.picture(self.light(*p)) - self.grey)[self.edges] ** 2).mean()
        best = cost(at)
        for turn in range(5):
            for i in range(3):
                for sign in (1, -1):
                    other = list(at)
                    other[i] += sign * steps[i]
                    if (i == 2 or other[i] > 0.2) and (now := cost(other)) < best:
                        best, at = now, other
            if turn:
                steps = [s / 2 for s in steps]
        return at

    def compressed(self, light, amplitudes, tables, rng):
        noise = rng.normal(0, 1, light.shape) * (amplitudes[0] + (amplitudes[1] - amplitudes[0]) * light)
        grey = np.where(self.inside_pixels(), self.picture(light) + noise, self.grey)
        file = io.BytesIO()
        Image.fromarray(np.clip(np.round(grey), 0, 255).astype(np.uint8)).save(file, "jpeg", qtables=tables)
        return file.getvalue()

    def inside_pixels(self):
        return cv2.dilate(self.inside[::FINE, ::FINE].astype(np.uint8), np.ones((9, 9))) > 0

    def drawn(self, tables, rng):
        """REPEATS pictures, and the numbers they were drawn with."""
        blur = self.fitted()
        light = np.clip(self.light(*blur), 0, 1)
        amplitudes = self.noise.copy()
        for _ in range(4):
            grey = np.array(Image.open(io.BytesIO(self.compressed(light, amplitudes, tables, rng)))).astype(float)
            now = np.array([even(grey, mask)[1] for mask in self.even])
            amplitudes *= np.clip(self.noise / now, 0.5, 2)
        return [self.compressed(light, amplitudes, tables, rng) for _ in range(REPEATS)], blur


def nearest(truth, found):
    """Found less true, corner by corner."""
    return found[np.linalg.norm(truth[:, None] - found[None], axis=2).argmin(1)] - truth


def main():
    if not FOLDER:
        print("ETENDUE_OPENCV_SAMPLES is not set: left out")
        return
    stored = json.loads(FIGURES.joinpath("opencv.json").read_text())
    views = [np.array(v, np.float32) for v in stored["views"].values()]
    many = [BOARD.astype(np.float32)] * len(views)
    _, matrix, d, turns, places = cv2.calibrateCamera(many, views, (WIDTH, HEIGHT), None, None)
    d = d.ravel()[:5]
    rng = np.random.default_rng(20)
    told, kept = {}, {}
    for name, turn, place in zip(stored["views"], turns, places):
        photograph = Image.open(pathlib.Path(FOLDER) / name)
        tables = photograph.quantization
        board = Board(np.array(photograph.convert("L")).astype(float), *board_places(matrix, d, turn, place))
        pictures, blur = board.drawn(tables, rng)
        truth = cv2.projectPoints(BOARD, turn, place, matrix, d)[0].reshape(-1, 2)
        decoded = [np.array(Image.open(io.BytesIO(picture))) for picture in pictures]
        errors = np.concatenate([nearest(truth, corners(picture)) for picture in decoded])
        told[name] = {
            "blur_px": [round(b, 3) for b in blur[:2]],
            "dark_narrower_px": round(blur[2], 3),
            "noise_grey_levels": [round(n, 2) for n in board.noise],
            "opencv_deviation_px": round(float(np.sqrt((errors**2).mean())), 4),
            "opencv_mean_px": [round(float(m), 4) for m in errors.mean(0)],
        }
        if name in STORED:
            kept[name] = np.round(truth, 4).tolist()
            FIGURES.joinpath(f"drawn-{name}").write_bytes(pictures[0])
        print(name, told[name], flush=True)
    figures = {"opencv": cv2.__version__, "repeats": REPEATS, "photographs": told, "drawn": kept}
    FIGURES.joinpath("corners.json").write_text(json.dumps(figures, separators=(",", ":")) + "\n")


main()
