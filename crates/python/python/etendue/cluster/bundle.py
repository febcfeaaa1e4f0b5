"""The files of a job, for machines that do not have them.

The tree of a bundle has every file under its absolute path as the job spells it, ``..`` taken away: below another root relative paths lead to the same
files, whatever links there are on the way here. Equal contents are held once.
"""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from pathlib import Path, PurePath

from .._errors import InputError


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
    """The bundle of a job that was opened by the path ``job``, of the paths that it read. Raises InputError with all that it names by absolute ones."""
    job = Path(job)
    why = "it is named by an absolute path, or by a file that is, which other machines do not have; name it relative to the file that names it"
    # Below the folder of a job that was opened by an absolute path are those that it names by relative ones.
    absolute = [_fault(path, why) for path in files if path.is_absolute() and job.parent not in path.parents]
    if absolute:
        raise InputError(absolute)
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


def in_tree(path):
    """Where a path lies in the tree: ``/``-separated, relative to its root."""
    return PurePath(os.path.normpath(Path.cwd() / path)).relative_to(Path.cwd().anchor).as_posix()


def _fault(path, why):
    return f"{path}: {why}", str(path), None, None, None
