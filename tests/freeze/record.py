"""The program under test, digests of what it makes, and the stored record: one text file a section, one line an entry."""

import hashlib
import json
import os
import subprocess
from argparse import Namespace
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
"""The root of the repository, from which commands are run."""

FOLDER = Path(__file__).resolve().parent / "record"

DIGITS = 16
"""Hexadecimal digits that are stored of a SHA-256: 64 bits, as many as `plan` prints of a hash."""

LONGEST_RUN_S = 3600

SKIPPED = "skipped"
"""The value of an entry that cannot be measured on this machine; it equals any other."""

FAILED = "exit status"
"""The beginning of the value of an entry whose command failed."""

Entries = dict[str, str]
"""Names of what is recorded, and what is recorded of each."""


@dataclass(frozen=True)
class Run:
    """Exit status and output of one run."""

    status: int
    out: bytes
    err: str

    def failure(self, command: str) -> str:
        """The entry of a run that should have succeeded; its messages go to standard error."""
        print(f"{command}\n{self.err}", flush=True)
        return f"{FAILED} {self.status}"


class Program:
    """A release binary of the command line, and the folder for temporary files."""

    def __init__(self, binary: Path, scratch: Path):
        self.binary = binary.resolve()
        self.scratch = scratch

    def run(self, arguments: list[str], cwd: Path = ROOT, prefix: tuple[str, ...] = (), env: dict[str, str] | None = None) -> Run:
        """Runs the program in a folder; `prefix` is the command that starts it, such as valgrind with its options."""
        done = subprocess.run(
            [*prefix, str(self.binary), *arguments],
            cwd=cwd,
            env=self.environment() | (env or {}),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=LONGEST_RUN_S,
        )
        return Run(done.returncode, done.stdout, done.stderr.decode("utf-8", "replace"))

    def environment(self) -> dict[str, str]:
        """The environment without variables that change what the program does or how its text is wrapped."""
        dropped = ("COLUMNS", "CLICOLOR", "CLICOLOR_FORCE", "FORCE_COLOR")
        kept = {
            name: value
            for name, value in os.environ.items()
            if name not in dropped and not name.startswith(("ETENDUE_", "RUST_"))
        }
        own = {"XDG_CACHE_HOME": str(self.scratch / "cache"), "NO_COLOR": "1", "TERM": "dumb"}
        # Results do not depend on the number of threads; one thread leaves the machine to others.
        return {"RAYON_NUM_THREADS": "1"} | kept | own


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:DIGITS]


def canonical(value) -> bytes:
    """JSON with sorted keys and without blanks."""
    return json.dumps(value, sort_keys=True, separators=(",", ":"), ensure_ascii=False).encode()


@dataclass(frozen=True)
class Section:
    """A part of the record: the heading of its file, the measurement of its entries, and the comparison of two values."""

    heading: str
    measure: Callable[[Program, Namespace], Entries]
    describe: Callable[[str, str], str]
    """The difference of a stored and a found value in words; empty where it counts as none."""


def write_detail(wanted: Namespace, path: str, data: bytes) -> None:
    """Writes what an entry stands for into the folder of `--details`, where one is given."""
    if wanted.details:
        file = wanted.details / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


def write(section: str, heading: str, entries: Entries) -> None:
    """Stores entries, sorted by name. An entry that was skipped keeps its stored value."""
    FOLDER.mkdir(exist_ok=True)
    before = read(section)
    lines = [f"# {line}" for line in heading.strip().splitlines()]
    for name, value in sorted(entries.items()):
        lines.append(f"{name}  {before.get(name, value) if value == SKIPPED else value}")
    (FOLDER / f"{section}.txt").write_text("\n".join(lines) + "\n", encoding="utf-8")


def read(section: str) -> Entries:
    """The stored entries; none where nothing is stored."""
    file = FOLDER / f"{section}.txt"
    if not file.is_file():
        return {}
    lines = file.read_text(encoding="utf-8").splitlines()
    pairs = (line.split("  ", 1) for line in lines if line and not line.startswith("#"))
    return {name: value for name, value in pairs}


def differences(stored: Entries, found: Entries, section: Section) -> list[str]:
    """One line for each entry that is new, missing or other."""
    lines = [f"{name}: missing, was {value}" for name, value in stored.items() if name not in found]
    for name, value in found.items():
        before = stored.get(name)
        if before is None:
            lines.append(f"{name}: new, {value}")
        elif value != before and SKIPPED not in (before, value) and (text := difference(before, value, section)):
            lines.append(f"{name}: {text}")
    return lines


def difference(before: str, value: str, section: Section) -> str:
    if before.startswith(FAILED) or value.startswith(FAILED):
        return was_and_is(before, value)
    return section.describe(before, value)


def was_and_is(stored: str, found: str) -> str:
    return f"was {stored}, is {found}"
