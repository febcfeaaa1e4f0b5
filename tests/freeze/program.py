"""The program under test, started with a controlled environment."""

import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
"""The root of the repository; every command of a job is run from here."""

LONGEST_RUN_S = 900


@dataclass
class Run:
    """Exit status and output of one run."""

    status: int
    out: bytes
    err: str


class Program:
    """A release binary of the command line, and the folder for its temporary files."""

    def __init__(self, binary: Path, scratch: Path):
        self.binary = binary.resolve()
        self.scratch = scratch

    def run(self, arguments: list[str], cwd: Path = ROOT, prefix: list[str] = (), env: dict[str, str] = {}) -> Run:
        """Runs the program in a folder; `prefix` is a command that starts it, such as valgrind with its options."""
        command = [*prefix, str(self.binary), *arguments]
        done = subprocess.run(
            command, cwd=cwd, env=self.environment() | env, stdin=subprocess.DEVNULL, capture_output=True, timeout=LONGEST_RUN_S
        )
        return Run(done.returncode, done.stdout, done.stderr.decode("utf-8", "replace"))

    def environment(self) -> dict[str, str]:
        """The environment without variables that change what the program does or how it wraps its text."""
        kept = {name: value for name, value in os.environ.items() if not name.startswith(("ETENDUE_", "RUST_"))}
        for name in ("COLUMNS", "CLICOLOR", "CLICOLOR_FORCE", "FORCE_COLOR"):
            kept.pop(name, None)
        own = {"XDG_CACHE_HOME": str(self.scratch / "cache"), "NO_COLOR": "1", "TERM": "dumb"}
        # No result depends on the number of threads; one thread leaves the machine to others.
        return {"RAYON_NUM_THREADS": "1"} | kept | own
