"""Digests of all files that small jobs write. The jobs stand in jobs.json, with the features that each covers."""

import json
import shutil
import sys
import time
from argparse import Namespace
from fnmatch import fnmatch
from pathlib import Path

import digest
import record
from program import ROOT, Program

HEADING = """
All files that the jobs of jobs.json write: SHA-256 of the file and, of PNG and OpenEXR, of its pixels without metadata
(the first 24 digits of each).
"""

TABLE = Path(__file__).resolve().parent / "jobs.json"


def measure(program: Program, wanted: Namespace) -> record.Entries:
    """Runs the named jobs, or all."""
    table = json.loads(TABLE.read_text(encoding="utf-8"))
    entries: record.Entries = {}
    for job in table["jobs"]:
        if wanted.jobs and job["name"] not in wanted.jobs:
            continue
        started = time.monotonic()
        folder = program.scratch / "results" / job["name"]
        folder.mkdir(parents=True)
        for number, step in enumerate(job["steps"]):
            if failure := run_step(program, step, folder):
                entries[f"{job['name']}/step {number}"] = failure
        entries |= files(job["name"], folder, table["excluded"])
        if wanted.details:
            shutil.copytree(folder, wanted.details / "results" / job["name"], dirs_exist_ok=True)
        shutil.rmtree(folder)
        print(f"results: {job['name']}, {time.monotonic() - started:.1f} s", flush=True)
    return entries


def run_step(program: Program, step: dict, folder: Path) -> str:
    """Runs one command of jobs.json; says how it failed, if it did.

    run     the arguments, in which `{}` is the job's folder
    size    columns, rows and pitch (um) of a camera's pixels; of a camera file under the name ""
    set     further changes of keys
    status  the expected exit status, 0 unless stated
    keep    the name of a file in the folder for what is printed
    inside  runs it from the job's folder, for results that hold a path
    """
    arguments = [word.replace("{}", str(folder)) for word in step["run"]]
    for camera, (width, height, pitch) in step.get("size", {}).items():
        sensor = f"cameras.{camera}.sensor" if camera else "sensor"
        arguments += [f"--set={sensor}.width_px={width}", f"--set={sensor}.height_px={height}", f"--set={sensor}.pixel_pitch_um={pitch}"]
    arguments += [f"--set={change}" for change in step.get("set", [])]
    cwd = folder if step.get("inside") else ROOT
    run = program.run(arguments, cwd=cwd, env=step.get("env", {}))
    if run.status != step.get("status", 0):
        print(f"etendue {' '.join(arguments)}\n{run.err}", file=sys.stderr)
        return f"exit status {run.status}"
    if "keep" in step:
        (folder / step["keep"]).write_bytes(run.out.replace(str(folder).encode(), b"."))
    return ""


def files(job: str, folder: Path, excluded: dict[str, str]) -> record.Entries:
    names = sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
    kept = (name for name in names if not any(fnmatch(f"{job}/{name}", pattern) for pattern in excluded))
    return {f"{job}/{name}": entry((folder / name).read_bytes()) for name in kept}


def entry(data: bytes) -> str:
    pixels = digest.pixels(data)
    return digest.digest(data) + (f" {digest.digest(pixels)}" if pixels is not None else "")


def describe(stored: str, found: str) -> str:
    """Other bytes; of pictures, whether the pixels are those that were stored."""
    before, after = stored.split(), found.split()
    if len(before) == 2 and len(after) == 2:
        return "other metadata, the same pixels" if before[1] == after[1] else "other pixels"
    return "other bytes"
