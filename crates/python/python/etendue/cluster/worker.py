"""Worker: renders one film of one shard. A repetition gives the same bytes, so the task of a lost worker is repeated by another."""

from __future__ import annotations

import _thread
import dataclasses
import os
import tempfile
import threading
from pathlib import Path

import numpy as np
import ray

from .. import __version__
from .._errors import RunError
from .bundle import open_copy

#: The open job of this process: tasks of one run follow one another, and reading a scene is slow.
_open = {}
#: Interval of progress reports, s.
TELL_EVERY_S = 0.5


@ray.remote(num_cpus=0)
class Progress:
    """Progress of each task, from 0 to 1, and its node."""

    def __init__(self):
        self._tasks = {}

    def tell(self, key, part, node):
        self._tasks[key] = (part, node)

    def told(self):
        return self._tasks


class _Line:
    """Thread that reports the progress of a task to the driver, and interrupts the task when the driver has given up."""

    def __init__(self, progress, task):
        self.part, self.is_cut = 0.0, False
        self._progress, self._task, self._node = progress, task, ray.get_runtime_context().get_node_id()
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._tell, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ended.set()
        self._thread.join()

    def _tell(self):
        while True:
            try:
                ray.get(self._progress.tell.remote(self._task, self.part, self._node))
            except ray.exceptions.ActorDiedError:
                self.is_cut = True
                # Like Ctrl-C: rendering ends before the next pixel.
                _thread.interrupt_main()
                return
            except ray.exceptions.RayError:
                pass
            if self._ended.wait(TELL_EVERY_S):
                return


def render_film(bundle, task, run, progress):
    """Files of the film ``task`` (name of the film, number of the shard) of a run: name to an array of bytes. Empty if the driver has given up."""
    _check_version(run)
    line = _Line(progress, task)
    try:
        with line:
            return _rendered(bundle, task, run, line)
    except KeyboardInterrupt:
        if line.is_cut:
            return {}
        raise


def _rendered(bundle, task, run, line):
    film, shard = task
    # A task reads and renders with its own processors.
    os.environ["RAYON_NUM_THREADS"] = str(run["threads"])
    job = _job(bundle, run)

    def tell(_, done, total):
        line.part = done / total

    with tempfile.TemporaryDirectory(prefix="etendue-") as folder:
        paths = job.save(
            folder, frames=range(*run["frames"]), shard=(shard, run["shards"]), films=[film], threads=run["threads"], progress=tell
        )
        return {Path(path).name: np.fromfile(path, dtype=np.uint8) for path in paths}


def _check_version(run):
    if __version__ != run["version"]:
        raise RunError(f"node {ray.util.get_node_ip_address()} has version {__version__} of etendue, and the driver {run['version']}; install the same")


def _job(bundle, run):
    """The job, opened from a copy of its files."""
    key = (bundle.digest(), repr(run["options"]))
    if key not in _open:
        _open.clear()
        contents = dict(zip(bundle.contents, ray.get(list(bundle.contents.values()))))
        _open[key] = open_copy(dataclasses.replace(bundle, contents=contents), run["options"], run["plan_hash"])
    return _open[key]
