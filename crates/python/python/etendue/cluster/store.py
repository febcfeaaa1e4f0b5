"""Finished parts of a run, in the folder ``.cluster`` of its results, from which the next run continues.

``run.json`` identifies the run; ``shard-00003`` is the folder of a shard as ``etendue render --shard`` writes it. A file has its final name when complete.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
from pathlib import Path

from .._errors import InputError, RunError

try:
    import fcntl
except ImportError:
    fcntl = None

FOLDER = ".cluster"
MANIFEST = "shard.json"
#: Maximum attempts to create a folder that other drivers keep removing.
TRIES = 100


class Store:
    """Finished films of one run, used by one driver at a time."""

    def __init__(self, results):
        self.results = Path(results)
        self.folder = self.results / FOLDER
        self._lock, self._taken = None, False

    def open(self, run, names, *, overwrite, resume):
        """Takes the folder for the run that the dict ``run`` describes and whose results have these names. Raises InputError if existing files conflict."""
        self._take()
        try:
            # Another driver may have removed earlier files before the folder was taken.
            old = self._old()
            self._check_in_the_way(old, run, names, overwrite, resume)
        except InputError:
            self._give_back()
            raise
        if overwrite:
            self._empty()
        if old is None or overwrite:
            self._write(self.folder / "run.json", json.dumps(run, indent=1).encode())

    def has(self, film, shard):
        """True if a film of a shard is finished."""
        folder = self._shard(shard)
        return not folder.is_symlink() and (folder / film).is_file() and (folder / MANIFEST).is_file()

    def add(self, film, shard, files):
        """Adds a finished film with its shard's manifest, name to bytes. Adding it again changes nothing."""
        self._shard(shard).mkdir(exist_ok=True)
        _check_link(self._shard(shard))
        self._check_beside(self._shard(shard) / MANIFEST, bytes(files[MANIFEST]))
        for name in (MANIFEST, film):
            self._write(self._shard(shard) / name, files[name])

    def shards(self, count):
        """The folders of all shards, for ``merge``."""
        return [self._shard(shard) for shard in range(count)]

    def remove(self):
        """Removes all parts, once the results exist, and releases the folder for another driver."""
        shutil.rmtree(self.folder)
        self._let_go()

    def close(self):
        """Releases the folder for another driver, and removes it if nothing is finished."""
        if self._taken and not any(self.folder.glob("shard-*/*")):
            shutil.rmtree(self.folder, ignore_errors=True)
            with contextlib.suppress(OSError):
                self.results.rmdir()
        self._let_go()

    def _give_back(self):
        """Releases a folder in which nothing was written, and removes it if it was created for that."""
        with contextlib.suppress(OSError):
            self.folder.rmdir()
        self._let_go()

    def _let_go(self):
        if self._lock is not None:
            os.close(self._lock)
        self._lock, self._taken = None, False

    def _shard(self, shard):
        return self.folder / f"shard-{shard:05}"

    def _check_beside(self, path, manifest):
        """Checks that films of a shard have equal tiles: tiles are not part of the plan's hash."""
        cut = lambda text: {key: value for key, value in json.loads(text).items() if key != "request"}
        if path.exists() and cut(path.read_bytes()) != cut(manifest):
            raise RunError(f"{path}: its films have other tiles (render.tile_px); begin anew with --overwrite")

    def _check_in_the_way(self, old, run, names, overwrite, resume):
        """Refuses to replace parts of an ``old`` run (None: there is none) and results, unless requested."""
        if old is not None and not (overwrite or resume):
            raise _refused(self.folder, "a run was interrupted here; go on with --resume, or begin anew with --overwrite")
        if old is None and not overwrite:
            there = next((name for name in names if (self.results / name).exists()), None)
            if there is not None:
                raise _refused(self.results / there, "it is there already; choose another output folder, or --overwrite it")
        if old is not None and resume and old != run:
            differ = ", ".join(key for key in run if old.get(key) != run[key])
            raise _refused(self.folder, f"it is of a run with other values of {differ}; repeat that run, or begin anew with --overwrite")

    def _old(self):
        path = self.folder / "run.json"
        try:
            return json.loads(path.read_text())
        except FileNotFoundError:
            return None
        except OSError as cause:
            raise _refused(path, f"it cannot be read: {cause.strerror}") from None
        except ValueError:
            raise _refused(path, "it is damaged; remove the folder, or begin anew with --overwrite") from None

    def _take(self):
        """Creates the folder and locks it. A driver that ends removes it: the locked folder must still have the name."""
        for _ in range(TRIES):
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
            except (FileNotFoundError, FileExistsError) as cause:
                # Removed concurrently, or there is a file of that name.
                why = cause.strerror
                continue
            except OSError as cause:
                raise _refused(self.folder, f"the folder cannot be made: {cause.strerror}") from None
            _check_link(self.folder)
            why = "it is removed at once"
            self._taken = fcntl is None or self._is_locked()
            if self._taken:
                return
            self._let_go()
        raise _refused(self.folder, f"the folder cannot be made: {why}; choose another")

    def _is_locked(self):
        """Locks the folder; returns true if it still has this name."""
        try:
            self._lock = os.open(self.folder, os.O_RDONLY)
            fcntl.flock(self._lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return os.path.samestat(os.fstat(self._lock), os.stat(self.folder))
        except FileNotFoundError:
            return False
        except BlockingIOError:
            self._let_go()
            raise _refused(self.folder, "another run writes into this folder; wait for it, or choose another") from None
        except OSError as cause:
            self._give_back()
            raise _refused(self.folder, f"the folder cannot be locked: {cause.strerror}; choose one on another file system") from None

    def _empty(self):
        for entry in self.folder.iterdir():
            shutil.rmtree(entry) if entry.is_dir() and not entry.is_symlink() else entry.unlink()

    def _write(self, path, content):
        new = path.with_name(path.name + ".new")
        try:
            new.unlink(missing_ok=True)
            with open(new, "xb") as file:
                file.write(content)
                file.flush()
                os.fsync(file.fileno())
            os.replace(new, path)
        except OSError as cause:
            with contextlib.suppress(OSError):
                new.unlink()
            raise RunError(f"{path}: cannot be written: {cause.strerror}") from None


def _check_link(folder):
    """Refuses a link: its maker would choose where files are written or removed."""
    if folder.is_symlink():
        raise _refused(folder, "a symbolic link is in the place of a folder of results; remove it, or choose another output folder")


def _refused(path, why):
    return InputError([(f"{path}: {why}", str(path), None, None, None, "unwritable-output")])
