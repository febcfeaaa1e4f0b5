"""The comparison: every renderer, every scene, efficiencies and ratios of one run. See README.md."""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
from pathlib import Path

import numpy as np

import efficiency
import etendue
import scenes
from spectra import ROOT

HERE = Path(__file__).resolve().parent
RENDERERS = ("etendue", "mitsuba", "cycles")


def command(renderer, binary):
    if renderer == "etendue":
        return [binary, "--peer"]
    return [sys.executable, str(HERE / renderer / "render.py")]


class Bench:
    """One run."""

    def __init__(self, options):
        self.options = options
        self.target = Path(options.target)

    def render(self, renderer, scene, spp, seeds):
        """Luminances and processor seconds of independent pictures."""
        folder, kind = self.target / "scenes" / scene, "f32" if renderer == "etendue" else "npy"
        out = self.target / "out" / f"{scene}-{renderer}-{spp}-%.{kind}"
        out.parent.mkdir(parents=True, exist_ok=True)
        place = folder / "job.toml" if renderer == "etendue" else folder
        arguments = [str(place), str(out), str(spp), str(self.options.threads), *map(str, seeds)]
        done = subprocess.run(command(renderer, self.options.binary) + arguments, stdout=subprocess.PIPE,
                              stderr=None if self.options.verbose else subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(f"{renderer} could not render {scene}:\n{done.stderr}")
        seconds = [float(line.split()[1]) for line in done.stdout.splitlines() if line]
        return [self.read(renderer, folder, str(out).replace("%", str(s))) for s in seeds], seconds

    @staticmethod
    def read(renderer, folder, path):
        if renderer == "etendue":
            return etendue.luminance(folder, path)
        return np.load(path).astype(float)

    def measured(self, scene):
        """All renderers take turns, one picture each."""
        o = self.options
        pictures, seconds = {r: [] for r in o.renderers}, {r: [] for r in o.renderers}
        for seed in range(1, o.runs + 1):
            for renderer in o.renderers:
                image, taken = self.render(renderer, scene, o.spp, [seed])
                pictures[renderer] += image
                seconds[renderer] += taken
        return pictures, seconds

    def scene(self, name):
        described = self.target / "scenes" / name / "scene.json"
        scenes.write(name, described.parent)
        pictures, seconds = self.measured(name)
        rows = {r: self.row(pictures[r], seconds[r]) for r in self.options.renderers}
        for renderer, row in rows.items():
            row["etendue_over_this"] = rows["etendue"]["efficiency"] / row["efficiency"]
            row["agreement"] = None if renderer == "etendue" else agreement(pictures["etendue"], pictures[renderer])
        return {"triangles": json.loads(described.read_text())["triangles"], "renderers": rows}

    def row(self, pictures, seconds):
        error, taken = efficiency.relative_mse(pictures), statistics.median(seconds)
        paths = scenes.WIDTH * scenes.HEIGHT * self.options.spp
        return {"cpu_s": taken, "cpu_s_runs": seconds, "us_a_path": 1e6 * taken / paths, "relative_mse": error,
                "efficiency": 1.0 / (error * taken)}


def agreement(ours, theirs):
    """How far two renderers are apart: the ratio of means, and the farthest region with its standard error."""
    ratio, error = efficiency.ratios(theirs, ours)
    far = np.argmax(np.abs(ratio - 1.0))
    total = np.mean(theirs) / np.mean(ours)
    return {"mean_ratio": float(total), "farthest_region": float(ratio[far]), "its_standard_error": float(error[far]),
            "median_region": float(np.median(np.abs(ratio - 1.0)))}


def table(found):
    lines = ["| scene | renderer | CPU s | us a path | relative MSE | efficiency | Etendue over this | mean ratio | "
             "farthest region |", "| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for name, scene in found["scenes"].items():
        for renderer, row in scene["renderers"].items():
            apart = row["agreement"]
            beside = ["", ""] if apart is None else [
                f"{apart['mean_ratio']:.4f}", f"{apart['farthest_region']:.3f} ± {apart['its_standard_error']:.3f}"]
            cells = [name, renderer, f"{row['cpu_s']:.2f}", f"{row['us_a_path']:.2f}", f"{row['relative_mse']:.4f}",
                     f"{row['efficiency']:.3f}", f"{row['etendue_over_this']:.2f}", *beside]
            lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=list(scenes.SCENES), help="cornell, street, night; or all")
    parser.add_argument("--binary", default=str(ROOT / "target/release/etendue-benches"))
    parser.add_argument("--target", default=str(ROOT / "target/peers"))
    parser.add_argument("--renderers", nargs="+", default=list(RENDERERS), choices=RENDERERS)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--runs", type=int, default=5, help="pictures of each renderer, which take turns; 2 or more")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--verbose", action="store_true", help="show what the renderers say")
    return parser.parse_args()


def main():
    options = arguments()
    bench = Bench(options)
    options.renderers = sorted({"etendue", *options.renderers}, key=RENDERERS.index)
    found = {"machine": platform.processor() or platform.machine(), "options": vars(options),
             "load_before": os.getloadavg()[0], "scenes": {}}
    for name in options.scenes:
        found["scenes"][name] = bench.scene(name)
        (bench.target / "result.json").write_text(json.dumps(found, indent=1) + "\n")
    found["load_after"] = os.getloadavg()[0]
    (bench.target / "result.json").write_text(json.dumps(found, indent=1) + "\n")
    print(table(found))
    print(f"\nLoad of the machine before and after: {found['load_before']:.1f}, {found['load_after']:.1f}. "
          f"In full: {bench.target / 'result.json'}")


if __name__ == "__main__":
    main()
