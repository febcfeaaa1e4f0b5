"""The files of a job, for machines that do not have them.

The tree of a bundle has every file under its absolute path as the job spells it, with ``..`` resolved: below another root relative paths lead to the same
files, whatever links the paths contain here. Equal contents are stored once.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from dataclasses import dataclass
from pathlib import Path, PurePath

from .. import Job
from .._errors import InputError, RunError

ABSOLUTE = "it is named by an absolute path, or by a file that is, which other machines do not have; name it relative to the file that names it"


@dataclass(frozen=True)
class Bundle:
    """Path of the job in the tree, content hash of each file by path, folders, and contents by SHA-256 (bytes, or a reference)."""

    job: str
    files: dict[str, str]
    folders: frozenset[str]
    contents: dict[str, object]

    def digest(self):
        """Hash that is equal for equal trees."""
        told = sorted(self.files.items()), self.job, sorted(self.folders)
        return hashlib.sha256(repr(told).encode()).hexdigest()

    def write(self, root):
        """Writes the tree below a folder, from contents that are bytes or arrays of bytes; returns the path of the job."""
        root = Path(root).resolve()
        for name in sorted(self.folders):
            (root / name).mkdir(parents=True, exist_ok=True)
        for name, content in self.files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_bytes(self.contents[content])
        return root / self.job


def gather(job, files):
    """Bundle of a job that was opened by the path ``job``, from the paths that it read. Raises InputError with all paths that it cannot contain."""
    job = Path(job)
    # Files below the folder of a job opened by an absolute path may be named by relative or absolute paths: see open_copy.
    absolute = [_fault(path, ABSOLUTE) for path in files if path.is_absolute() and job.parent not in path.parents]
    above = [_fault(path, "its .. lead above the root of the file system; leave those out") for path in files if _is_above_root(path)]
    if absolute or above:
        raise InputError(absolute + above)
    places, contents, folders = {}, {}, set()
    for path in files:
        place = in_tree(path)
        content = path.read_bytes()
        name = hashlib.sha256(content).hexdigest()
        if places.setdefault(place, name) != name:
            raise InputError([_fault(path, "a link on its way makes two files of one name; name both by their own paths")])
        contents[name] = content
        # The system resolves x/../y through x.
        folders.update(in_tree(parent) for parent in path.parents if parent.parts)
    return Bundle(in_tree(job), places, frozenset(folders - {""}), contents)


def open_copy(bundle, options, plan_hash):
    """The job, opened from a copy of its files that is removed after reading. Raises InputError with all files that it reads outside the copy, by
    absolute paths; RunError if its plan has another hash, or it reads other files."""
    try:
        with tempfile.TemporaryDirectory(prefix="etendue-") as folder:
            root = Path(folder).resolve()
            job = Job.open(bundle.write(root), **options)
    except OSError as cause:
        raise RunError(f"a copy of the job's files cannot be made: {cause}") from None
    paths = [Path(os.path.normpath(path)) for path in job.files]
    elsewhere = [_fault(path, ABSOLUTE) for path in paths if root not in path.parents]
    if elsewhere:
        raise InputError(elsewhere)
    if job.plan()["hash"] != plan_hash or {path.relative_to(root).as_posix() for path in paths} != bundle.files.keys():
        raise RunError("the files of the job have changed since the driver read them; begin the run anew")
    return job


def in_tree(path):
    """Path in the tree: ``/``-separated, relative to its root."""
    return PurePath(os.path.normpath(Path.cwd() / path)).relative_to(Path.cwd().anchor).as_posix()


def _is_above_root(path):
    """True if ``..`` leads above the root: the system stays at the root, but a tree below another root is left."""
    depth = 0
    for part in (Path.cwd() / path).relative_to(Path.cwd().anchor).parts:
        depth += -1 if part == ".." else 1
        if depth < 0:
            return True
    return False


def _fault(path, why):
    return f"{path}: {why}", str(path), None, None, None, "outside-folder"
