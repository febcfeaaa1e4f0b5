"""Instructions of rendering, counted by valgrind's callgrind: those of many samples a pixel less those of few, so that reading, compiling
and writing cancel.

One thread; the same binary counts the same within 1 part in 10 000. The accelerator chooses its instruction set at run time: valgrind 3.19
shows AVX2 where the processor has it, and never AVX-512.
"""

import re
import shutil
import subprocess
from argparse import Namespace
from dataclasses import dataclass
from pathlib import Path

import record
from record import Program

HEADING = """
Instructions of one path (rendering: a run of many samples a pixel less one of few, by the paths between them), and of the
run of few samples, which is mostly reading and compiling; one thread, under valgrind's callgrind.
"""

TOLERANCE = {"path": 0.01, "start": 0.03}
"""The greatest relative difference that counts as none."""


@dataclass(frozen=True)
class Scene:
    """A job, the size of its picture, and the two numbers of samples a pixel."""

    job: str
    columns: int
    rows: int
    pitch_um: float
    few: int
    many: int

    def paths(self) -> int:
        return self.columns * self.rows * (self.many - self.few)


SCENES = {
    "cornell": Scene("scenes/cornell/cornell.toml", 32, 32, 781.25, few=4, many=68),
    "street": Scene("scenes/street/street.toml", 32, 20, 180, few=4, many=196),
    "night": Scene("scenes/street/night.toml", 32, 20, 180, few=4, many=132),
}

ONLY_RAW = "output={ raw = true, picture = false, ground_truth = false }"


def measure(program: Program, _wanted: Namespace) -> record.Entries:
    if not shutil.which("valgrind"):
        print("instructions: skipped, as valgrind is not installed", flush=True)
        return {name: record.SKIPPED for name in ["machine", *(f"{scene} {part}" for scene in SCENES for part in TOLERANCE)]}
    entries: record.Entries = {"machine": machine()}
    for name, scene in SCENES.items():
        few, many = (count(program, scene, spp) for spp in (scene.few, scene.many))
        entries[f"{name} path"] = f"{(many - few) / scene.paths():.1f}"
        entries[f"{name} start"] = str(few)
        print(f"instructions: {name}, {entries[f'{name} path']} a path", flush=True)
    return entries


def count(program: Program, scene: Scene, spp: int) -> int:
    """Instructions of a whole run."""
    folder = program.scratch / "instructions"
    size = {"width_px": scene.columns, "height_px": scene.rows, "pixel_pitch_um": scene.pitch_um}
    changes = [f"--set=cameras.front.sensor.{key}={value}" for key, value in size.items()]
    arguments = ["render", scene.job, "-o", str(folder), "--overwrite", "--threads", "1", "--spp", str(spp)]
    callgrind = ("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null")
    run = program.run([*arguments, *changes, f"--set={ONLY_RAW}"], prefix=callgrind)
    collected = re.search(r"Collected *: *(\d+)", run.err)
    if run.status != 0 or not collected:
        raise SystemExit(f"{scene.job} under valgrind: exit status {run.status}\n{run.err}")
    return int(collected[1])


def machine() -> str:
    """What the counts depend on besides the binary: the version of valgrind, and the instruction set that the accelerator finds."""
    version = subprocess.run(["valgrind", "--version"], capture_output=True, text=True, check=True).stdout.strip()
    processor = Path("/proc/cpuinfo")
    flags = processor.read_text(encoding="utf-8").split() if processor.is_file() else []
    return f"{version} {'avx2' if 'avx2' in flags else 'scalar'}"


def describe(stored: str, found: str) -> str:
    """Counts within the tolerance are the same."""
    if "valgrind" in stored:
        return f"{stored} has become {found}: store the counts of the unchanged binary on this machine first"
    change = float(found) / float(stored) - 1
    tolerance = TOLERANCE["path" if "." in stored else "start"]
    return f"{change:+.2%}, from {stored} to {found}" if abs(change) > tolerance else ""


SECTION = record.Section(HEADING, measure, describe)
