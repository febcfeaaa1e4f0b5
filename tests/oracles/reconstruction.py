"""What OpenCV makes of rendered pictures, beside the ground truth that is written with them: figures/reconstruction.json.

The binary renders two frames of figures/reconstruction/room.toml by a rectified pair: pictures of 8 bits, disparity (.pfm), flow (.flo) and
poses. From the pictures alone come

- disparity: cv2.StereoSGBM of frame 0;
- flow: cv2.DISOpticalFlow from frame 0 to frame 1 of the left camera;
- relative poses by SIFT: left to right by cv2.findEssentialMat (MAGSAC) and cv2.recoverPose, whose length is not known; left frame 0 to
  frame 1 by cv2.solvePnPRansac on points in space that the disparity above and the stated base give;
- the video: what cv2.VideoCapture reads of picture.y4m beside the pictures.

Stored are the errors over all pixels that the truth calls seen in the other picture, and the estimates at every eighth pixel, which
a test holds against the truth that the program traces anew. Versions: requirements.txt. Needs the binary; without an argument it is built:
    python tests/oracles/reconstruction.py [BINARY] [FOLDER OF A RENDER TO KEEP]
"""

import json
import pathlib
import subprocess
import sys
import tempfile

import cv2
import numpy as np
import OpenEXR

ROOT = pathlib.Path(__file__).parent
FIGURES = ROOT / "figures"
ROOM = FIGURES / "reconstruction"
MATRIX = np.array([[300.0, 0.0, 159.5], [0.0, 300.0, 119.5], [0.0, 0.0, 1.0]])
STEP = 8
SEEN = 1


def binary():
    if len(sys.argv) > 1:
        return sys.argv[1]
    root = ROOT.parent.parent
    subprocess.run(["cargo", "build", "--release", "-p", "etendue-cli"], cwd=root, check=True)
    return str(root / "target" / "release" / "etendue")


def noise():
    """A periodic texture with structure of all sizes from 2 to 32 px, 16 levels."""
    rng, side = np.random.default_rng(7), 256
    picture = np.zeros((side, side))
    for sigma in (1.0, 2.0, 4.0, 8.0, 16.0):
        layer = cv2.GaussianBlur(np.tile(rng.normal(size=(side, side)), (3, 3)), (0, 0), sigma)[side:2 * side, side:2 * side]
        picture += layer / layer.std()
    ranks = picture.ravel().argsort().argsort().reshape(side, side) / (side * side)
    cv2.imwrite(str(ROOM / "noise.png"), (20 + 14 * np.floor(16 * ranks)).astype(np.uint8))


def layer(file, name):
    with OpenEXR.File(str(file), separate_channels=True) as exr:
        return np.array(exr.channels()[name].pixels)


def errors(estimate, truth, valid):
    """Of vectors of the last axis."""
    off = np.linalg.norm(estimate - truth, axis=-1)[valid]
    return {"pixels": int(valid.sum()), "median_px": float(np.median(off)), "mean_px": float(off.mean()),
            "outliers_over_3_px": float((off > 3.0).mean())}


def at_steps(picture, digits=3):
    numbers = picture[STEP // 2::STEP, STEP // 2::STEP].astype(float)
    return [None if not np.isfinite(v).all() else np.round(v, digits).tolist() for v in numbers.reshape(-1, *numbers.shape[2:])]


def disparity(out, left, right):
    matcher = cv2.StereoSGBM.create(minDisparity=0, numDisparities=32, blockSize=5, P1=8 * 25, P2=32 * 25, uniquenessRatio=5,
                                    speckleWindowSize=50, speckleRange=2, mode=cv2.STEREO_SGBM_MODE_HH)
    raw = matcher.compute(left, right)
    estimate = np.where(raw >= 0, raw / 16.0, np.nan)
    truth = cv2.imread(str(out / "left" / "disparity.0000.pfm"), cv2.IMREAD_UNCHANGED)
    seen = layer(out / "left" / "disparity.0000.exr", "visibility.ID") == SEEN
    valid = seen & np.isfinite(estimate)
    return estimate, {"errors": errors(estimate[..., None], truth[..., None], valid),
                      "found": float((valid & seen).sum() / seen.sum()), "estimate": at_steps(estimate)}


def flow(out, first, second):
    finder = cv2.DISOpticalFlow.create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    finder.setFinestScale(0)
    estimate = finder.calc(first, second, None)
    truth = cv2.readOpticalFlow(str(out / "left" / "flow_forward.0000.flo"))
    seen = layer(out / "left" / "motion.0000.exr", "visibility.forward.ID") == SEEN
    return {"errors": errors(estimate, truth, seen), "estimate": at_steps(estimate)}


def matched(first, second):
    """Places of features that two pictures share, pixel centres at whole numbers."""
    sift = cv2.SIFT.create(contrastThreshold=0.02, enable_precise_upscale=True)
    (k1, d1), (k2, d2) = sift.detectAndCompute(first, None), sift.detectAndCompute(second, None)
    pairs = [a for a, b in cv2.BFMatcher().knnMatch(d1, d2, k=2) if a.distance < 0.75 * b.distance]
    return np.array([k1[m.queryIdx].pt for m in pairs]), np.array([k2[m.trainIdx].pt for m in pairs])


def relative(rotation, translation, matches, inliers):
    """The second camera's frame against the first's: x2 = R x1 + t."""
    return {"rotation_rad": cv2.Rodrigues(rotation)[0].ravel().tolist() if rotation.shape == (3, 3) else rotation.ravel().tolist(),
            "translation": translation.ravel().tolist(), "matches": int(matches), "inliers": int(inliers)}


def by_epipolar_lines(first, second):
    p1, p2 = matched(first, second)
    cv2.setRNGSeed(1)
    essential, inliers = cv2.findEssentialMat(p1, p2, MATRIX, method=cv2.USAC_MAGSAC, prob=0.9999, threshold=1.0)
    _, rotation, translation, inliers = cv2.recoverPose(essential, p1, p2, MATRIX, mask=inliers)
    return relative(rotation, translation, len(p1), (inliers > 0).sum())


def by_points(first, second, disparities, base_m):
    p1, p2 = matched(first, second)
    columns, rows = np.round(p1).astype(int).T
    d = disparities[rows, columns]
    known = np.isfinite(d) & (d > 0.0)
    p1, p2, z = p1[known], p2[known], MATRIX[0, 0] * base_m / d[known]
    points = np.column_stack([(p1 - MATRIX[:2, 2]) / MATRIX[0, 0], np.ones(len(p1))]) * z[:, None]
    cv2.setRNGSeed(1)
    _, turn, shift, inliers = cv2.solvePnPRansac(points, p2, MATRIX, None, iterationsCount=2000, reprojectionError=1.0, confidence=0.9999)
    inside = inliers.ravel()
    turn, shift = cv2.solvePnPRefineLM(points[inside], p2[inside], MATRIX, None, turn, shift)
    return relative(turn, shift, len(p1), len(inside))


def pose(out, camera, frame):
    facts = json.loads((out / camera / f"frame.{frame:04}.json").read_text())
    m = np.array(facts["camera_to_world"])
    return m[:, :3], m[:, 3]


def with_errors(found, first, second):
    """Errors of a relative pose against the stated ones, degrees."""
    (r1, p1), (r2, p2) = first, second
    rotation, translation = r2.T @ r1, r2.T @ (p1 - p2)
    off = cv2.Rodrigues(cv2.Rodrigues(np.array(found["rotation_rad"]))[0] @ rotation.T)[0]
    there = np.array(found["translation"])
    cosine = there @ translation / np.linalg.norm(there) / np.linalg.norm(translation)
    return found | {"rotation_error_deg": float(np.degrees(np.linalg.norm(off))),
                    "direction_error_deg": float(np.degrees(np.arccos(min(1.0, cosine)))),
                    "length_ratio": float(np.linalg.norm(there) / np.linalg.norm(translation))}


def video(out):
    """Largest difference of the luma that OpenCV reads from BT.709's of the pictures, in numbers of 8 bits; the rate."""
    file = cv2.VideoCapture(str(out / "left" / "picture.y4m"))
    frames, most = 0, 0.0
    while True:
        ok, picture = file.read()
        if not ok:
            break
        shown = cv2.imread(str(out / "left" / f"picture.{frames:04}.png")).astype(float)
        # A mono camera's picture is grey: no matrix of colours is in the comparison.
        most = max(most, float(np.abs(picture.astype(float) - shown).max()))
        frames += 1
    return {"frames": frames, "frame_rate_hz": file.get(cv2.CAP_PROP_FPS), "largest_difference": most}


def examined(out):
    grey = lambda camera, frame: cv2.imread(str(out / camera / f"picture.{frame:04}.png"), cv2.IMREAD_GRAYSCALE)
    left, right, later = grey("left", 0), grey("right", 0), grey("left", 1)
    at = lambda camera, frame: pose(out, camera, frame)
    disparities, of_pair = disparity(out, left, right)
    base_m = np.linalg.norm(at("right", 0)[1] - at("left", 0)[1])
    return {"program": f"OpenCV {cv2.__version__}", "step_px": STEP, "disparity": of_pair, "flow": flow(out, left, later),
            "video": video(out), "left_to_right": with_errors(by_epipolar_lines(left, right), at("left", 0), at("right", 0)),
            "frame_0_to_1": with_errors(by_points(left, later, disparities, base_m), at("left", 0), at("left", 1))}


def main():
    noise()
    with tempfile.TemporaryDirectory() as place:
        out = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pathlib.Path(place) / "out"
        subprocess.run([binary(), "render", str(ROOM / "room.toml"), "-o", str(out), "--frames", "0..2", "--overwrite"], check=True)
        figures = examined(out)
    (FIGURES / "reconstruction.json").write_text(json.dumps(figures, indent=None, separators=(",", ":")) + "\n")
    short = lambda value: {k: v for k, v in value.items() if k != "estimate"} if isinstance(value, dict) else value
    print(json.dumps({k: short(v) for k, v in figures.items()}, indent=1))


if __name__ == "__main__":
    main()
