"""The files of a job, for machines that do not have them.

The tree of a bundle has every file under its absolute path as the job spells it, ``..`` taken away: below another root relative paths lead to the same
files, whatever links there are on the way here. Equal contents are held once.
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
    """The job's place in the tree, the content of each file by its place, folders, and contents: SHA-256 to what holds it (bytes, or a reference)."""

    job: str
    files: dict[str, str]
    folders: frozenset[str]
    contents: dict[str, object]

    def digest(self):
        """Equal for equal trees."""
        told = sorted(self.files.items()), self.job, sorted(self.folders)
        return hashlib.sha256(repr(told).encode()).hexdigest()

    def write(self, root):
        """Writes the tree below a folder, of contents that are bytes or arrays of bytes; answers with the path of the job."""
        root = Path(root).resolve()
        for name in sorted(self.folders):
            (root / name).mkdir(parents=True, exist_ok=True)
        for name, content in self.files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_bytes(self.contents[content])
        return root / self.job


def gather(job, files):
    """The bundle of a job that was opened by the path ``job``, of the paths that it read. Raises InputError with all that can have no place in it."""
    job = Path(job)
    # Below the folder of a job that was opened by an absolute path are those that it names by relative ones, and perhaps others: see open_copy.
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
        # A system follows x/../y through x.
        folders.update(in_tree(parent) for parent in path.parents if parent.parts)
    return Bundle(in_tree(job), places, frozenset(folders - {""}), contents)


def open_copy(bundle, options, plan_hash):
    """The job, opened from a copy of its files that is gone when they are read. Raises InputError with all files that it reads elsewhere, which it names by
    absolute paths; RunError where its plan has another hash, or it reads other files."""
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
    """Where a path lies in the tree: ``/``-separated, relative to its root."""
    return PurePath(os.path.normpath(Path.cwd() / path)).relative_to(Path.cwd().anchor).as_posix()


def _is_above_root(path):
    """Whether ``..`` leads above the root: a system stays there, a tree below another root is left."""
    depth = 0
    for part in (Path.cwd() / path).relative_to(Path.cwd().anchor).parts:
        depth += -1 if part == ".." else 1
        if depth < 0:
            return True
    return False


def _fault(path, why):
    return f"{path}: {why}", str(path), None, None, None, "outside-folder"
