"""What the tests share: the job of the repository's tests, the program, and what folders hold."""

import os
import pathlib
import subprocess
import sys

import pytest

import etendue

ROOT = pathlib.Path(__file__).resolve().parents[3]
JOB = ROOT / "crates/cli/tests/jobs/small/small.toml"


@pytest.fixture(scope="session")
def job():
    """A little of everything that changes bits."""
    return etendue.Job.open(JOB)


@pytest.fixture(scope="session")
def results(job):
    return job.render()


@pytest.fixture
def program():
    """Runs the program, or where ETENDUE_BINARY names none the package's own command: what it prints."""
    binary = os.environ.get("ETENDUE_BINARY")
    command = [binary] if binary else [sys.executable, "-m", "etendue"]

    def run(*arguments, status=0):
        done = subprocess.run([*command, *map(str, arguments)], cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == status, done.stderr
        return done.stdout

    return run


def contents(folder):
    """The bytes of all files, by their names."""
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}
