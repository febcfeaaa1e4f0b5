"""Charts rendered with calibrated cameras and handed to OpenCV: figures/charts.json, figures/charts.

Two cameras, perspective with OpenCV's five coefficients and OpenCV's fisheye, each from 28 poses before a chequerboard, written as a
job with calibration files in OpenCV's own format, rendered by the binary, and calibrated by OpenCV from nothing but the pictures
and the size of the squares.

- The picture: black squares that throw nothing back before even light without end, so that every pixel is the share of its area
  that is not covered, without noise of light; no electronic noise; the illumination is stated as even over the picture.
- The corners: found by findChessboardCornersSB on eight bits, refined by cornerSubPix on the picture of 16 bits, blurred by a
  Gaussian of 1.5 px. Both look for the point about which the picture is antisymmetrical, which a corner of four squares is and the box
  of a pixel leaves so; a centre of a circle is none in perspective. Without the blur the edges, one pixel wide, alias, and
  cornerSubPix alone is 0.05 px off (RMS); with it 0.015 px. Its window is 13 × 13 px, over which distortion bends edges by less than
  0.005 px.
- The calibration: cv2.calibrateCameraExtended and cv2.fisheye.calibrate, whose standard deviations come from here: those of the
  least-squares problem that it solves, by its own derivatives.

Versions: requirements.txt. Needs the binary; without an argument it is built:
    python tests/oracles/charts.py [BINARY]
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np

ROOT = pathlib.Path(__file__).parent
FIGURES = ROOT / "figures"
JOBS = FIGURES / "charts"
WIDTH, HEIGHT = 640, 480
VIEWS = 28
COLUMNS, ROWS, SQUARE_M = 11, 8, 0.03
# Camera matrices with the centre of the top-left pixel at (0, 0).
CAMERAS = {
    "perspective": {"matrix": [[612.4, 0.0, 316.8], [0.0, 605.9, 243.1], [0.0, 0.0, 1.0]],
                    "coefficients": [-0.21, 0.07, 0.0006, -0.0004, -0.012], "nearest_m": 0.22, "farthest_m": 0.75},
    "fisheye": {"matrix": [[291.7, 0.0, 322.3], [0.0, 288.4, 236.6], [0.0, 0.0, 1.0]],
                "coefficients": [0.021, -0.0083, 0.0031, -0.0006], "nearest_m": 0.10, "farthest_m": 0.40},
}
# Board (and camera: x right, y down, z ahead) to world (x ahead, y left, z up).
AXES = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])


def board():
    """The inner corners, m, about the board's middle."""
    x, y = np.meshgrid(np.arange(COLUMNS) - (COLUMNS - 1) / 2, np.arange(ROWS) - (ROWS - 1) / 2)
    return SQUARE_M * np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])


def project(name, points, rvec, tvec, matrix=None, coefficients=None):
    """Pixels of board points, centres at whole numbers."""
    matrix = np.array(CAMERAS[name]["matrix"] if matrix is None else matrix)
    coefficients = np.array(CAMERAS[name]["coefficients"] if coefficients is None else coefficients)
    if name == "fisheye":
        return cv2.fisheye.projectPoints(points[:, None, :], rvec, tvec, matrix, coefficients)[0].reshape(-1, 2)
    return cv2.projectPoints(points, rvec, tvec, matrix, coefficients)[0].reshape(-1, 2)


def poses(name, rng):
    """Poses at which all corners and what refines them are inside the picture, first those that reach furthest into its corners."""
    camera, found = CAMERAS[name], []
    while len(found) < 2000:
        tilt, turn, about = np.radians(rng.uniform(12.0, 42.0)), rng.uniform(0.0, 2.0 * np.pi), np.radians(rng.uniform(-20, 20))
        rotation = cv2.Rodrigues(tilt * np.array([np.cos(turn), np.sin(turn), 0.0]))[0] @ cv2.Rodrigues(np.array([0.0, 0.0, about]))[0]
        at = rng.uniform(-1.0, 1.0, 2) * (0.9, 0.7) * (1.2 if name == "fisheye" else 0.6)
        distance = rng.uniform(camera["nearest_m"], camera["farthest_m"])
        rvec, tvec = cv2.Rodrigues(rotation)[0].ravel(), distance * np.array([at[0], at[1], 1.0])
        if (board() @ rotation.T + tvec)[:, 2].min() < 0.03:
            continue
        pixels = project(name, board(), rvec, tvec)
        grid = pixels.reshape(ROWS, COLUMNS, 2)
        spacing = min(np.linalg.norm(np.diff(grid, axis=a), axis=2).min() for a in (0, 1))
        inside = (pixels > 14).all() and (pixels[:, 0] < WIDTH - 15).all() and (pixels[:, 1] < HEIGHT - 15).all()
        if inside and spacing > 17.0:
            found.append((rvec, tvec, pixels))
    return spread(found)


def spread(found):
    """Of many poses those whose corners come nearest to the picture's corners, and others in their order."""
    chosen = []
    for corner in [(0, 0), (WIDTH, 0), (0, HEIGHT), (WIDTH, HEIGHT)]:
        reach = [np.linalg.norm(pixels - corner, axis=1).min() for _, _, pixels in found]
        chosen += [int(i) for i in np.argsort(reach)[:4] if i not in chosen]
    chosen += [i for i in range(len(found)) if i not in chosen][:VIEWS - len(chosen)]
    return [found[i] for i in chosen]


def entry(i, rvec, tvec):
    """A camera of the job, by its pose before the board."""
    rotation = cv2.Rodrigues(rvec)[0]
    turn = AXES @ rotation.T @ AXES.T
    position = AXES @ (-rotation.T @ tvec)
    angles = np.degrees([np.arctan2(turn[1, 0], turn[0, 0]), -np.arcsin(turn[2, 0]), np.arctan2(turn[2, 1], turn[2, 2])])
    text = lambda numbers: "[" + ", ".join(f"{x:.12f}" for x in numbers) + "]"
    return f'[[cameras]]\nname = "view-{i:02}"\nfile = "NAME-camera.toml"\nposition_m = {text(position)}\nrotation_deg = {text(angles)}\n'


JOB = """# Written by tests/oracles/charts.py: a chequerboard from 28 places.
format = 1

[scene]
meshes = [{ name = "board", file = "board.obj", up_axis = "z" }]
materials = [{ name = "black", type = "diffuse", reflectance = 0 }]
objects = [{ name = "board", mesh = "board", material = "black" }]
environment = { type = "uniform", radiance_w_m2_sr_nm = 1 }

[render]
spp = 64
replicates = 1
integrator = "flat"
wavelengths_per_path = 1
wavelength_range_nm = [540, 560]

[output]
ground_truth = false

"""

CAMERA = """# Written by tests/oracles/charts.py: a calibration file, even illumination, a sensor without noise.
format = 1

[lens]
type = "calibrated"
f_number = 4
calibration = { file = "NAME.yml", format = "FORMAT" }
relative_illumination = { radius_mm = [0, 4], ratio = [1, 1] }

[sensor]
width_px = 640
height_px = 480
pixel_pitch_um = 6
exposure_s = 1e-3
cfa = "mono"
quantum_efficiency = 1
full_well_e = 2e5
read_noise_e = 0
dark_current_e_s = 0
gain_dn_per_e = 0.6
black_level_dn = 0
bits = 16
noise = false
"""


def board_file():
    """The black squares: every other one of a field one square wider than the inner corners on all sides."""
    lines = ["# Written by tests/oracles/charts.py: the black squares of a chequerboard, m."]
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            if (i + j) % 2 == 0:
                x, y = (i - (COLUMNS + 1) / 2) * SQUARE_M, (j - (ROWS + 1) / 2) * SQUARE_M
                square = np.array([[x, y, 0], [x, y + SQUARE_M, 0], [x + SQUARE_M, y + SQUARE_M, 0], [x + SQUARE_M, y, 0]])
                lines += ["v " + " ".join(f"{c:.6g}" for c in corner) for corner in square @ AXES.T]
                lines.append("f -4 -3 -2 -1")
    (JOBS / "board.obj").write_text("\n".join(lines) + "\n")


def files(name, views):
    storage = cv2.FileStorage(str(JOBS / f"{name}.yml"), cv2.FILE_STORAGE_WRITE)
    for key, value in [("image_width", WIDTH), ("image_height", HEIGHT), ("camera_matrix", np.array(CAMERAS[name]["matrix"])),
                       ("distortion_coefficients", np.array([CAMERAS[name]["coefficients"]]).T)]:
        storage.write(key, value)
    storage.release()
    kind = "opencv_fisheye" if name == "fisheye" else "opencv"
    (JOBS / f"{name}-camera.toml").write_text(CAMERA.replace("NAME", name).replace("FORMAT", kind))
    entries = [entry(i, rvec, tvec).replace("NAME", name) for i, (rvec, tvec, _) in enumerate(views)]
    (JOBS / f"{name}.toml").write_text(JOB + "\n".join(entries))


def rendered(binary, name, folder):
    out = pathlib.Path(folder) / name
    if not out.exists():
        subprocess.run([binary, "render", str(JOBS / f"{name}.toml"), "-o", str(out)], check=True, stdout=subprocess.DEVNULL)
    read = lambda i: cv2.imread(str(out / f"view-{i:02}" / "raw.0000.png"), cv2.IMREAD_UNCHANGED)
    return [read(i).astype(np.float32) / read(i).max() for i in range(VIEWS)]


def corners(picture):
    """Inner corners, centres at whole numbers, in the board's order (or turned by half); None where the board is not found."""
    eight = np.round(255.0 * picture).astype(np.uint8)
    found, coarse = cv2.findChessboardCornersSB(eight, (COLUMNS, ROWS), flags=cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE)
    if not found:
        return None
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-5)
    fine = cv2.cornerSubPix(cv2.GaussianBlur(picture, (0, 0), 1.5), coarse, (6, 6), (-1, -1), criteria)
    fine = fine.reshape(-1, 2).astype(float)
    return fine if fine[0, 0] < fine[COLUMNS - 1, 0] else fine[::-1]


def perspective(pictures_corners):
    points = [board().astype(np.float32)] * len(pictures_corners)
    images = [c.astype(np.float32)[:, None, :] for c in pictures_corners]
    rms, matrix, coefficients, rvecs, tvecs, deviations, _, _ = cv2.calibrateCameraExtended(
        points, images, (WIDTH, HEIGHT), None, None, criteria=(cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-12))
    return rms, matrix, coefficients.ravel(), np.ravel(deviations)[:9], rvecs, tvecs


def fisheye(pictures_corners):
    points = [board()[None, :, :]] * len(pictures_corners)
    images = [c[None, :, :] for c in pictures_corners]
    flags = cv2.CALIB_RECOMPUTE_EXTRINSIC | cv2.CALIB_FIX_SKEW
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-12)
    rms, matrix, coefficients, rvecs, tvecs = cv2.fisheye.calibrate(points, images, (WIDTH, HEIGHT), None, None, flags=flags, criteria=criteria)
    return rms, matrix, coefficients.ravel(), fisheye_deviations(pictures_corners, matrix, coefficients, rvecs, tvecs), rvecs, tvecs


def fisheye_deviations(found, matrix, coefficients, rvecs, tvecs):
    """Standard deviations of fx, fy, cx, cy, k1 … k4: the diagonal of s² (JᵀJ)⁻¹ with the poses in J."""
    normal, square, count = np.zeros((8 + 6 * len(found),) * 2), 0.0, 0
    for i, (seen, rvec, tvec) in enumerate(zip(found, rvecs, tvecs)):
        pixels, j = cv2.fisheye.projectPoints(board()[:, None, :], rvec, tvec, matrix, coefficients)
        # Columns: f (2), c (2), k (4), rotation (3), translation (3), alpha.
        rows = np.zeros((j.shape[0], normal.shape[0]))
        rows[:, :8], rows[:, 8 + 6 * i:14 + 6 * i] = j[:, :8], j[:, 8:14]
        normal += rows.T @ rows
        square, count = square + ((pixels.reshape(-1, 2) - seen) ** 2).sum(), count + j.shape[0]
    return np.sqrt(np.diag(np.linalg.inv(normal)) * square / (count - normal.shape[0]))[:8]


def directions(name):
    """Directions of a grid of pixels up to the picture's edges, by the true camera, and the pixels."""
    x, y = np.meshgrid(np.linspace(-0.5, WIDTH - 0.5, 33), np.linspace(-0.5, HEIGHT - 0.5, 25))
    pixels = np.column_stack([x.ravel(), y.ravel()])
    matrix, k = np.array(CAMERAS[name]["matrix"]), np.array(CAMERAS[name]["coefficients"])
    criteria = (cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 500, 1e-14)
    if name == "fisheye":
        ideal = cv2.fisheye.undistortPoints(pixels[:, None, :], matrix, k, criteria=criteria)
    else:
        ideal = cv2.undistortPoints(pixels[:, None, :], matrix, k, None, None, None, criteria)
    rays = np.column_stack([ideal.reshape(-1, 2), np.ones(len(pixels))])
    zero = np.zeros(3)
    assert np.abs(project(name, rays, zero, zero) - pixels).max() < 1e-6, "the grid of the true camera is exact"
    return rays, pixels


def curve(name, matrix, coefficients):
    """The distortion's curve: the radius of a field angle along the diagonal, estimated less true, with the true camera matrix."""
    rays, pixels = directions(name)
    reach = np.linalg.norm(rays[:, :2], axis=1).max()
    tangents = np.linspace(0.0, reach, 65)
    line = np.column_stack([0.8 * tangents, 0.6 * tangents, np.ones_like(tangents)])
    zero, true = np.zeros(3), np.array(CAMERAS[name]["matrix"])
    centre = lambda m: np.array([m[0][2], m[1][2]])
    mine = project(name, line, zero, zero, matrix, coefficients) - centre(matrix)
    theirs = project(name, line, zero, zero) - centre(true)
    whole = project(name, rays, zero, zero, matrix, coefficients) - pixels
    return {"curve_px": float(np.abs(np.linalg.norm(mine, axis=1) - np.linalg.norm(theirs, axis=1)).max()),
            "field_px": float(np.linalg.norm(whole, axis=1).max())}


def figures(name, binary, folder):
    views = poses(name, np.random.default_rng(20261121))
    files(name, views)
    found = [corners(picture) for picture in rendered(binary, name, folder)]
    used = [i for i, c in enumerate(found) if c is not None]
    seen = [found[i] for i in used]
    off = [seen[n] - views[i][2] for n, i in enumerate(used)]
    rms, matrix, coefficients, deviations, _, _ = (fisheye if name == "fisheye" else perspective)(seen)
    true = np.array(CAMERAS[name]["matrix"])
    pick = lambda m: [m[0, 0], m[1, 1], m[0, 2], m[1, 2]]
    return {
        "matrix": CAMERAS[name]["matrix"], "coefficients": CAMERAS[name]["coefficients"],
        "views": len(views), "found": len(used), "corners": int(sum(len(c) for c in seen)), "rms_px": rms,
        "estimated": {"fx_fy_cx_cy": pick(matrix), "coefficients": coefficients.tolist(), "deviations": deviations.tolist()},
        "off": {"fx_fy_cx_cy": (np.array(pick(matrix)) - pick(true)).tolist()} | curve(name, matrix, coefficients),
        "corners_off": {"mean_px": np.vstack(off).mean(axis=0).tolist(), "rms_px": float(np.sqrt((np.vstack(off) ** 2).mean())),
                        "worst_px": float(np.abs(np.vstack(off)).max())},
        "seen_px": {f"view-{i:02}": [round(float(v), 4) for v in seen[n].ravel()] for n, i in enumerate(used)},
    }


def built():
    subprocess.run(["cargo", "build", "--release", "-p", "etendue-cli"], check=True, cwd=ROOT.parent.parent)
    return str(ROOT.parent.parent / "target" / "release" / "etendue")


def main():
    binary = sys.argv[1] if len(sys.argv) > 1 else built()
    JOBS.mkdir(exist_ok=True)
    board_file()
    with tempfile.TemporaryDirectory() as folder:
        cameras = {name: figures(name, binary, sys.argv[2] if len(sys.argv) > 2 else folder) for name in CAMERAS}
    program = f"opencv-contrib-python-headless {cv2.__version__}"
    result = {"program": program, "board": {"columns": COLUMNS, "rows": ROWS, "square_m": SQUARE_M}, "cameras": cameras}
    (FIGURES / "charts.json").write_text(json.dumps(result, separators=(",", ":")).replace('"view-', '\n"view-') + "\n")
    for name, camera in cameras.items():
        print(name, json.dumps({k: v for k, v in camera.items() if k != "seen_px"}, indent=1))


if __name__ == "__main__":
    main()
