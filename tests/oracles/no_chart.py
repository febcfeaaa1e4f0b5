"""Pictures without a chart are refused: figures/checkerboard/no_chart.json.

All pictures of OpenCV's examples (Debian's opencv-doc 4.6.0: /usr/share/doc/opencv-doc/examples) but its photographs of a
checkerboard (data/chessboard.png, data/left*.jpg, data/right*.jpg) are given to `etendue measure distortion --target
checkerboard`, and `--target dots`; what it answers is stored. None may be taken for a chart. Of these photographs data/left03.jpg and
data/left04.jpg are given for dots as well: they show a checkerboard on a screen, too.
    ETENDUE_OPENCV_SAMPLES=.../examples/data ETENDUE=target/release/etendue python tests/oracles/no_chart.py
"""

import json
import os
import pathlib
import re
import subprocess
import sys

FOLDER = os.environ.get("ETENDUE_OPENCV_SAMPLES")
PROGRAM = os.environ.get("ETENDUE", "target/release/etendue")
FIGURES = pathlib.Path(__file__).parent / "figures" / "checkerboard" / "no_chart.json"


def is_chart(name):
    return name == "data/chessboard.png" or name.startswith(("data/left", "data/right"))


def answer(file, target):
    run = subprocess.run([PROGRAM, "measure", "distortion", file, "--target", target], capture_output=True, text=True)
    return run.returncode, re.sub(r"^error(\[[\w-]+\])?: " + re.escape(f"{file}: "), "", run.stderr.strip())


def main():
    if not FOLDER:
        print("ETENDUE_OPENCV_SAMPLES is not set: left out")
        return
    root = pathlib.Path(FOLDER).parent
    files = sorted(f for f in root.rglob("*") if f.suffix in (".png", ".jpg"))
    told, accepted = {}, []
    for file in files:
        name = str(file.relative_to(root))
        targets = ["dots"] if name in ("data/left03.jpg", "data/left04.jpg") else ["checkerboard", "dots"]
        if is_chart(name) and len(targets) > 1:
            continue
        for target in targets:
            status, reason = answer(str(file), target)
            told.setdefault(name, {})[target] = reason.split(":")[0]
            if status != 2:
                accepted.append((name, target))
    figures = {"opencv_doc": "4.6.0+dfsg-12", "pictures": len(told), "accepted": accepted, "answers": told}
    FIGURES.write_text(json.dumps(figures, indent=0, ensure_ascii=False) + "\n")
    print(len(told), "pictures, accepted:", accepted)
    sys.exit(bool(accepted))


main()
