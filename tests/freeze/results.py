"""Digests of all files that small jobs write. The jobs stand in jobs.json, with the features that each covers and with what is left out."""

import json
import shutil
import struct
import time
from argparse import Namespace
from pathlib import Path

import record
from record import ROOT, Program

HEADING = """
All files that the jobs of jobs.json write: SHA-256 of the file and, of PNG and OpenEXR, of its pixels without metadata
(the first 16 digits of each).
"""

TABLE = Path(__file__).resolve().parent / "jobs.json"

PNG = b"\x89PNG\r\n\x1a\n"
EXR = b"\x76\x2f\x31\x01"
EXR_MULTIPART = 0x1000


def measure(program: Program, wanted: Namespace) -> record.Entries:
    """Runs all jobs, or those that are named."""
    entries: record.Entries = {}
    for job in json.loads(TABLE.read_text(encoding="utf-8"))["jobs"]:
        if wanted.jobs and job["name"] not in wanted.jobs:
            continue
        started = time.monotonic()
        entries |= run_job(program, wanted, job)
        print(f"results: {job['name']}, {time.monotonic() - started:.1f} s", flush=True)
    return entries


def run_job(program: Program, wanted: Namespace, job: dict) -> record.Entries:
    entries: record.Entries = {}
    folder = program.scratch / "results" / job["name"]
    folder.mkdir(parents=True)
    for source in job.get("copy", []):
        shutil.copy(ROOT / source, folder)
    for number, step in enumerate(job["steps"]):
        if failure := run_step(program, step, folder):
            entries[f"{job['name']}/step {number}"] = failure
            break
    for path in sorted(path for path in folder.rglob("*") if path.is_file()):
        name, data = f"{job['name']}/{path.relative_to(folder).as_posix()}", path.read_bytes()
        entries[name] = entry(data)
        record.write_detail(wanted, f"results/{name}", data)
    shutil.rmtree(folder)
    return entries


def run_step(program: Program, step: dict, folder: Path) -> str:
    """Runs one command of jobs.json; the entry of its failure, or nothing.

    run     the arguments, in which `{}` is the job's folder
    size    columns, rows and pitch (um) of a camera's pixels; of a camera file under the name ""
    set     further changes of keys
    env     environment variables
    status  the expected exit status, 0 unless stated
    keep    the name of a file in the folder for what is printed
    inside  runs it from the job's folder, for results that hold a path
    """
    arguments = [word.replace("{}", str(folder)) for word in step["run"]]
    for camera, (width, height, pitch) in step.get("size", {}).items():
        sensor = f"cameras.{camera}.sensor" if camera else "sensor"
        arguments += [f"--set={sensor}.width_px={width}", f"--set={sensor}.height_px={height}", f"--set={sensor}.pixel_pitch_um={pitch}"]
    arguments += [f"--set={change}" for change in step.get("set", [])]
    run = program.run(arguments, cwd=folder if step.get("inside") else ROOT, env=step.get("env"))
    if run.status != step.get("status", 0):
        return run.failure(f"etendue {' '.join(arguments)}")
    if "keep" in step:
        kept = folder / step["keep"]
        kept.parent.mkdir(exist_ok=True)
        kept.write_bytes(run.out.replace(str(folder).encode(), b"."))
    return ""


def entry(data: bytes) -> str:
    inner = pixels(data)
    return record.digest(data) + (f" {record.digest(inner)}" if inner is not None else "")


def describe(stored: str, found: str) -> str:
    """Other bytes; of pictures, whether the pixels are those that were stored."""
    before, after = stored.split(), found.split()
    if len(before) == 2 and len(after) == 2:
        return "other metadata, the same pixels" if before[1] == after[1] else "other pixels"
    return "other bytes"


def pixels(data: bytes) -> bytes | None:
    """The compressed pixels of a PNG or of an OpenEXR file of one part, without names, texts and other metadata; `None` of other files."""
    if data.startswith(PNG):
        return b"".join(body for kind, body in png_chunks(data) if kind in (b"IHDR", b"PLTE", b"IDAT"))
    if data.startswith(EXR) and not struct.unpack_from("<I", data, 4)[0] & EXR_MULTIPART:
        return exr_chunks(data)
    return None


def png_chunks(data: bytes):
    """Type and contents of each chunk."""
    at = len(PNG)
    while at + 8 <= len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        yield kind, data[at + 8 : at + 8 + length]
        at += 12 + length


def exr_chunks(data: bytes) -> bytes:
    """What follows the header and the table of offsets."""
    at = 8
    while data[at] != 0:
        at = data.index(0, at) + 1  # the attribute's name
        at = data.index(0, at) + 1  # its type
        at += 4 + struct.unpack_from("<I", data, at)[0]
    first_chunk = struct.unpack_from("<Q", data, at + 1)[0]
    return data[first_chunk:]


SECTION = record.Section(HEADING, measure, describe)
