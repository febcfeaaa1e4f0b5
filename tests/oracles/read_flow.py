"""Figures of OpenCV for crates/io: figures/read_flow.json.

Reads the flow and disparity files that crates/io wrote (figures/flow.flo, flow_kitti.png, disparity_kitti.png, disparity.pfm; a test
holds them to the byte) and states their numbers, row by row from the top: of flow u, v, of KITTI's PNG u, v, valid as stored.
Versions: requirements.txt. Run anywhere:
    python tests/oracles/read_flow.py
"""

import json
import pathlib

import cv2
import numpy as np

FIGURES = pathlib.Path(__file__).parent / "figures"


def as_json(value):
    value = float(value)
    return value if np.isfinite(value) else str(value)


def picture(name):
    read = cv2.imread(str(FIGURES / name), cv2.IMREAD_UNCHANGED)
    # OpenCV has blue first.
    return read[..., ::-1] if read.ndim == 3 else read


def main():
    read = {"flow.flo": cv2.readOpticalFlow(str(FIGURES / "flow.flo"))}
    read |= {name: picture(name) for name in ("flow_kitti.png", "disparity_kitti.png", "disparity.pfm")}
    figures = {"program": f"OpenCV {cv2.__version__}"}
    figures |= {name: [as_json(v) for v in numbers.flatten()] for name, numbers in read.items()}
    (FIGURES / "read_flow.json").write_text(json.dumps(figures, indent=1) + "\n")


if __name__ == "__main__":
    main()
