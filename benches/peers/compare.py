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
import report
import scenes
from spectra import ROOT

HERE = Path(__file__).resolve().parent
# Etendue as it is, with guided paths, with four branches, with path reuse, and with guided paths of both kinds, by the name of its job.
OURS = {"etendue": "job.toml", "etendue-guided": "job-guided.toml", "etendue-branched": "job-branched.toml",
        "etendue-guided-branched": "job-guided-branched.toml", "etendue-reuse": "job-reuse.toml",
        "etendue-guided-reuse": "job-guided-reuse.toml"}
PEERS = ("mitsuba", "cycles")
RENDERERS = (*OURS, *PEERS)


def command(renderer, binary):
    if renderer in OURS:
        return [binary, "--peer"]
    return [sys.executable, str(HERE / renderer / "render.py")]


class Bench:
    """One run."""

    def __init__(self, options):
        self.options = options
        self.target = Path(options.target)
        self.instructions = {}

    def render(self, renderer, scene, spp, seeds):
        """Luminances and processor seconds of independent pictures."""
        folder, kind = self.target / "scenes" / scene, "f32" if renderer in OURS else "npy"
        out = self.target / "out" / f"{scene}-{renderer}-{spp}-%.{kind}"
        out.parent.mkdir(parents=True, exist_ok=True)
        place = folder / OURS.get(renderer, "")
        arguments = [str(place), str(out), str(spp), str(self.options.threads), *map(str, seeds)]
        done = subprocess.run(command(renderer, self.options.binary) + arguments, stdout=subprocess.PIPE,
                              stderr=None if self.options.verbose else subprocess.PIPE, text=True)
        if done.returncode:
            sys.exit(f"{renderer} could not render {scene}:\n{done.stderr}")
        lines = done.stdout.splitlines()
        self.instructions |= {renderer: line[2:] for line in lines if line.startswith("# ")}
        seconds = [float(line.split()[1]) for line in lines if line and not line.startswith("#")]
        return [self.read(renderer, folder, str(out).replace("%", str(s))) for s in seeds], seconds

    @staticmethod
    def read(renderer, folder, path):
        if renderer in OURS:
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
        folder = self.target / "scenes" / name
        scenes.write(name, folder)
        described = json.loads((folder / "scene.json").read_text())
        pictures, seconds = self.measured(name)
        rows = {r: self.row(pictures[r], seconds[r], described.get("road")) for r in self.options.renderers}
        for peer in self.options.renderers:
            if peer in PEERS:
                rows[peer]["beside"] = {r: beside(rows[r], rows[peer]) for r in OURS if r in rows}
                rows[peer]["agreement"] = agreement(pictures[self.options.renderers[0]], pictures[peer])
        return {"triangles": described["triangles"], "renderers": rows}

    def row(self, pictures, seconds, road):
        error, box, taken = efficiency.relative_mse(pictures), efficiency.box_mse(pictures), statistics.median(seconds)
        paths = scenes.WIDTH * scenes.HEIGHT * self.options.spp
        return {"cpu_s": taken, "cpu_s_runs": seconds, "us_a_path": 1e6 * taken / paths, "relative_mse": error,
                "efficiency": 1.0 / (error * taken), "box_mse": box, "box_efficiency": 1.0 / (box * taken),
                "road_rms": road and efficiency.road_rms(pictures, road)}


def beside(ours, theirs):
    """Ours over theirs."""
    return {key: ours[key] / theirs[key] for key in ("us_a_path", "efficiency", "box_efficiency")}


def agreement(ours, theirs):
    """How far two renderers are apart: the ratio of means, and the farthest region with its standard error."""
    ratio, error = efficiency.ratios(theirs, ours)
    far = np.argmax(np.abs(ratio - 1.0))
    total = np.mean(theirs) / np.mean(ours)
    return {"mean_ratio": float(total), "farthest_region": float(ratio[far]), "its_standard_error": float(error[far]),
            "median_region": float(np.median(np.abs(ratio - 1.0)))}


def processor():
    """The processor's name as Linux tells it."""
    known = Path("/proc/cpuinfo")
    lines = known.read_text().splitlines() if known.exists() else []
    return next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), platform.machine())


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("scenes", nargs="*", default=list(scenes.SCENES),
                        help=f"{', '.join(scenes.SCENES)}; or all")
    parser.add_argument("--binary", default=str(ROOT / "target/release/etendue-benches"))
    parser.add_argument("--target", default=str(ROOT / "target/peers"))
    parser.add_argument("--renderers", nargs="+", default=list(PEERS), choices=PEERS,
                        help="peers beside Etendue, which always renders without and with guided paths, branches and path reuse")
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--runs", type=int, default=5, help="pictures of each renderer, which take turns; 2 or more")
    parser.add_argument("--threads", type=int, default=os.cpu_count())
    parser.add_argument("--verbose", action="store_true", help="show what the renderers say")
    options = parser.parse_args()
    if unknown := set(options.scenes) - set(scenes.SCENES):
        parser.error(f"no scene {', '.join(sorted(unknown))}; there are {', '.join(scenes.SCENES)}")
    return options


def main():
    options = arguments()
    bench = Bench(options)
    options.renderers = sorted({*OURS, *options.renderers}, key=RENDERERS.index)
    found = {"processor": processor(), "options": vars(options), "load_before": os.getloadavg()[0], "scenes": {}}
    for name in options.scenes:
        found["scenes"][name] = bench.scene(name)
        found |= {"instructions": bench.instructions, "load_after": os.getloadavg()[0]}
        (bench.target / "result.json").write_text(json.dumps(found, indent=1) + "\n")
    print(report.text(found))
    print(f"\nIn full: {bench.target / 'result.json'}")


if __name__ == "__main__":
    main()
