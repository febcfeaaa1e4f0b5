"""What a run has finished, in the folder ``.cluster`` of its results: the next run goes on after it.

``run.json`` says of which run; ``shard-00003`` is the folder of a shard as ``etendue render --shard`` writes it. A file is under its name when it is whole.
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
#: How often a folder is made that other drivers remove at that moment.
TRIES = 100


class Store:
    """The finished films of one run, one driver's at a time."""

    def __init__(self, results):
        self.results = Path(results)
        self.folder = self.results / FOLDER
        self._lock, self._taken = None, False

    def open(self, run, names, *, overwrite, resume):
        """Takes the folder for the run that the dict ``run`` describes and whose results have these names. Raises InputError where what is there is in the way."""
        self._take()
        try:
            # What was there before the folder was taken another driver may have removed since.
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
        """Whether a film of a shard is finished."""
        folder = self._shard(shard)
        return not folder.is_symlink() and (folder / film).is_file() and (folder / MANIFEST).is_file()

    def add(self, film, shard, files):
        """A finished film with its shard's manifest, name to bytes. Adding it again changes nothing."""
        self._shard(shard).mkdir(exist_ok=True)
        _check_link(self._shard(shard))
        self._check_beside(self._shard(shard) / MANIFEST, bytes(files[MANIFEST]))
        for name in (MANIFEST, film):
            self._write(self._shard(shard) / name, files[name])

    def shards(self, count):
        """The folders of all shards, for ``merge``."""
        return [self._shard(shard) for shard in range(count)]

    def remove(self):
        """Removes all that is kept, the results are there, and lets another driver take the folder."""
        shutil.rmtree(self.folder)
        self._let_go()

    def close(self):
        """Lets another driver take the folder, and leaves none behind where nothing is finished."""
        if self._taken and not any(self.folder.glob("shard-*/*")):
            shutil.rmtree(self.folder, ignore_errors=True)
            with contextlib.suppress(OSError):
                self.results.rmdir()
        self._let_go()

    def _give_back(self):
        """Lets go of a folder in which nothing was written: one that was made for it goes."""
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
        """Films of a shard were cut alike: tiles are no part of the plan's hash."""
        cut = lambda text: {key: value for key, value in json.loads(text).items() if key != "request"}
        if path.exists() and cut(path.read_bytes()) != cut(manifest):
            raise RunError(f"{path}: its films have other tiles (render.tile_px); begin anew with --overwrite")

    def _check_in_the_way(self, old, run, names, overwrite, resume):
        """Refuses to work over what an ``old`` run left (None: there is none) and over results, unless asked to."""
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
        """Makes the folder and locks it. A driver that ends removes it: what was locked must still be what has the name."""
        for _ in range(TRIES):
            try:
                self.folder.mkdir(parents=True, exist_ok=True)
            except (FileNotFoundError, FileExistsError) as cause:
                # Removed at that moment, or a file is in the way.
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
        """Locks the folder; whether it is still the one of this name."""
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
    """Nothing is written or removed through a link, as whoever made it chose where that is."""
    if folder.is_symlink():
        raise _refused(folder, "a symbolic link is in the place of a folder of results; remove it, or choose another output folder")


def _refused(path, why):
    return InputError([(f"{path}: {why}", str(path), None, None, None, "unwritable-output")])
