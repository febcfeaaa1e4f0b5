"""What a worker does: one film of one shard. Done twice it gives the same bytes, so that a lost worker's task is done again by another."""

from __future__ import annotations

import dataclasses
import os
import tempfile
import time
from pathlib import Path

import numpy as np
import ray

from .. import Job, __version__
from .._errors import RunError

#: The job that this process has open: tasks of one run follow one another, and reading a scene takes long.
_open = {}
#: Progress is told once in so many seconds.
TELL_EVERY_S = 0.5


@ray.remote(num_cpus=0)
class Progress:
    """How far each task is, from 0 to 1, and on which node."""

    def __init__(self):
        self._tasks = {}

    def tell(self, key, part, node):
        self._tasks[key] = (part, node)

    def told(self):
        return self._tasks


def render_film(bundle, task, run, progress):
    """The files of the film ``task`` (name of the film, number of the shard) of a run: name to an array of bytes."""
    _check_version(run)
    film, shard = task
    node = ray.get_runtime_context().get_node_id()
    progress.tell.remote(task, 0.0, node)
    # One task reads and renders with the processors that it has.
    os.environ["RAYON_NUM_THREADS"] = str(run["threads"])
    job = _job(bundle, run)
    told_s = time.monotonic()

    def tell(_, done, total):
        nonlocal told_s
        if time.monotonic() - told_s >= TELL_EVERY_S:
            told_s = time.monotonic()
            progress.tell.remote(task, done / total, node)

    with tempfile.TemporaryDirectory(prefix="etendue-") as folder:
        paths = job.save(
            folder, frames=range(*run["frames"]), shard=(shard, run["shards"]), films=[film], threads=run["threads"], progress=tell
        )
        return {Path(path).name: np.fromfile(path, dtype=np.uint8) for path in paths}


def _check_version(run):
    if __version__ != run["version"]:
        raise RunError(f"node {ray.util.get_node_ip_address()} has version {__version__} of etendue, and the driver {run['version']}; install the same")


def _job(bundle, run):
    """The job, opened from a copy of its files that is gone when they are read."""
    key = (bundle.digest(), repr(run["options"]))
    if key not in _open:
        _open.clear()
        contents = dict(zip(bundle.contents, ray.get(list(bundle.contents.values()))))
        with tempfile.TemporaryDirectory(prefix="etendue-") as folder:
            job = Job.open(dataclasses.replace(bundle, contents=contents).write(folder), **run["options"])
        if job.plan()["hash"] != run["plan_hash"]:
            raise RunError("the files of the job have changed since the driver read them; begin the run anew")
        _open[key] = job
    return _open[key]
