"""Driver: divides a job into tasks, passes them to Ray, stores the finished parts, and joins them."""

from __future__ import annotations

import contextlib
import socket

import numpy as np

from .. import Job, __version__, merge
from .._errors import InputError, RunError
from .bundle import gather, open_copy
from .store import Store

#: Maximum shards of a run.
MAX_SHARDS = 65_536
#: Time between checks of the tasks' progress, s.
LOOK_EVERY_S = 0.5
#: Timeout for a cluster's answer, s.
ANSWER_S = 10


def render(
    job,
    folder,
    *,
    shards,
    frames=None,
    address=None,
    threads=None,
    retries=3,
    overwrite=False,
    resume=False,
    progress=None,
    **options,
):
    """Renders a job on the machines of a Ray cluster into a folder: the files of ``etendue render``, byte for byte. Returns their paths.

    job: the path of a job file. The files that it reads are sent to the machines, which need a Python with the same etendue but no common folder.
    shards: parts of each film, 1 to 65536: every task renders one part of the light of one camera (of cameras of equal light together), where light
    depends on time of one frame.
    frames: a frame's number, or a range of consecutive ones. Default: frame 0.
    address: address of the cluster, "host:port", or "auto" for that of this machine, or "local" for this machine alone. None: that of RAY_ADDRESS, or else
    this machine alone. If Ray is already initialised, it is used unchanged.
    threads: processors of a task. Default: those of the smallest machine. No bit of the results depends on it.
    retries: maximum repetitions of a task whose worker was lost, 0 to 1000.
    overwrite: replaces files of an earlier run. resume: continues an interrupted run of the same job, frames and shards.
    progress: called with the current step, the amount done (including fractions of a task) and the total; an exception from it cancels, like Ctrl-C.
    options: set, spp, noise, seed, integrator, quality, camera of ``Job.open``.

    Raises InputError if the input is unusable, RunError if the run failed: finished parts are kept for ``resume``.
    """
    _check(shards, retries, threads, overwrite, resume, options)
    import ray
    import ray.util.scheduling_strategies

    films, names, plan_hash, bundle = _read(job, frames, options)
    # Converted as by JSON.
    run = {"version": __version__, "plan_hash": plan_hash, "frames": _bounds(frames), "shards": shards, "camera": options.get("camera")}
    open_copy(bundle, options, plan_hash)
    store = Store(folder)
    try:
        store.open(run, names, overwrite=overwrite, resume=resume)
        done = [(film, shard) for film in films for shard in range(shards) if store.has(film, shard)]
        tasks = [(film, shard) for film in films for shard in range(shards) if not store.has(film, shard)]
        if tasks:
            with _connected(ray, address):
                run = {**run, "options": options, "threads": _threads(ray, threads)}
                _Tasks(ray, store, retries, progress).run(bundle, tasks, run, len(done))
        paths = merge(store.shards(shards), job=job, output=folder, overwrite=overwrite or resume, progress=progress)
        store.remove()
        return paths
    finally:
        store.close()


def _read(job, frames, options):
    """Names of a job's films and results, hash of its plan, and its files. The memory for opening it is freed."""
    opened = Job.open(job, **options)
    return opened.film_names(frames), opened.file_names(frames), opened.plan()["hash"], gather(job, opened.files)


class _Tasks:
    """Tasks of a run, and the remaining ones."""

    def __init__(self, ray, store, retries, progress):
        self.ray, self.store, self.retries, self.tell = ray, store, retries, progress or (lambda *told: None)

    def run(self, bundle, tasks, run, done):
        """Runs the tasks and stores their results; ``done`` others were finished before."""
        from .worker import Progress, render_film

        ray = self.ray
        # It runs on the driver's machine, so the loss of another machine does not affect it.
        here = ray.util.scheduling_strategies.NodeAffinitySchedulingStrategy(ray.get_runtime_context().get_node_id(), soft=False)
        progress = Progress.options(scheduling_strategy=here).remote()
        sent = ray.put(_sent(ray, bundle))
        remote = ray.remote(render_film).options(num_cpus=run["threads"], max_retries=self.retries, scheduling_strategy="SPREAD")
        pending = {remote.remote(sent, task, run, progress): task for task in tasks}
        total = done + len(tasks)
        try:
            while pending:
                ready, _ = ray.wait(list(pending), num_returns=1, timeout=LOOK_EVERY_S)
                for reference in ready:
                    film, shard = pending[reference]
                    self.store.add(film, shard, self._got(reference, film, shard))
                    del pending[reference]
                self.tell("tasks", self._so_far(progress, pending, total), total)
        finally:
            # Pending tasks end when they can no longer report progress. (Ray 2.60 aborts the driver if it cancels a task that is ending.)
            ray.kill(progress)

    def _so_far(self, progress, pending, total):
        try:
            told = self.ray.get(progress.told.remote())
        except self.ray.exceptions.RayError as error:
            raise RunError(f"the process that gathers progress was lost ({_named(error)}); go on with --resume") from None
        return total - len(pending) + sum(told.get(task, (0.0, None))[0] for task in pending.values())

    def _got(self, reference, film, shard):
        exceptions = self.ray.exceptions
        try:
            files = self.ray.get(reference)
        except exceptions.RayTaskError as error:
            if isinstance(error.cause, (InputError, RunError)):
                raise error.cause from None
            raise RunError(f"{film}, shard {shard}: a worker failed ({_named(error.cause)}); go on with --resume") from None
        except exceptions.RayError as error:
            raise RunError(f"{film}, shard {shard}: its worker was lost {self.retries + 1} times ({_named(error)}); go on with --resume") from None
        if not files:
            raise RunError(f"{film}, shard {shard}: its worker gave up, for the process that gathers progress was lost; go on with --resume")
        return files


def _named(error):
    """An exception in one line."""
    return f"{type(error).__name__}: " + str(error).partition("\n")[0]


def _sent(ray, bundle):
    """The bundle with its contents in the object store: as arrays, which workers read in place."""
    references = {name: ray.put(np.frombuffer(content, dtype=np.uint8)) for name, content in bundle.contents.items()}
    return type(bundle)(bundle.job, bundle.files, bundle.folders, references)


@contextlib.contextmanager
def _connected(ray, address):
    if ray.is_initialized():
        yield
        return
    _check_answers(address)
    try:
        ray.init(address=address, log_to_driver=False, logging_level="warning")
    except (ConnectionError, ValueError, RuntimeError) as cause:
        why = str(cause).partition("\n")[0]
        raise _refused("--address", f"--address {address}: there is no Ray cluster ({why})") from None
    try:
        yield
    finally:
        ray.shutdown()


def _check_answers(address):
    """Refuses an address without a listener: Ray itself would try for minutes."""
    if address in (None, "auto", "local"):
        return
    host, _, port = address.rpartition(":")
    if not host or not port.isdigit() or "/" in host:
        raise _refused("--address", f"--address {address}: expected auto, local or HOST:PORT, as ray start tells it")
    try:
        socket.create_connection((host, int(port)), timeout=ANSWER_S).close()
    except (OSError, OverflowError) as cause:
        raise _refused("--address", f"--address {address}: nothing answers there ({cause}); start a cluster with ray start --head") from None


def _threads(ray, asked):
    """Processors of a task: those of the smallest machine unless requested otherwise."""
    counts = [int(node["Resources"].get("CPU", 0)) for node in ray.nodes() if node["Alive"]]
    counts = [count for count in counts if count > 0]
    if not counts:
        raise _refused("--address", "the cluster has no machine with processors")
    if asked is not None and asked > max(counts):
        raise _refused("--threads", f"--threads {asked}: the largest machine of the cluster has {max(counts)} processors; give as many or fewer")
    return min(counts) if asked is None else asked


OPTIONS = ("set", "spp", "noise", "seed", "integrator", "quality", "camera")


def _check(shards, retries, threads, overwrite, resume, options):
    ranges = [("shards", shards, 1, MAX_SHARDS), ("retries", retries, 0, 1000), ("threads", threads, 1, 1024)]
    ranges += [("spp", options.get("spp"), 1, 2**32 - 1), ("seed", options.get("seed"), 0, 2**63 - 1)]
    for name, value, least, most in ranges:
        if value is None and name in ("threads", "spp", "seed"):
            continue
        if not isinstance(value, int) or isinstance(value, bool) or not least <= value <= most:
            raise _refused(f"--{name}", f"--{name} {value}: expected a whole number from {least} to {most}")
    if overwrite and resume:
        raise _refused("--resume", "--resume and --overwrite exclude one another; give one of them")
    unknown = [name for name in options if name not in OPTIONS]
    if unknown:
        raise TypeError(f"{unknown[0]}: no option of a run on a cluster; there are {', '.join(OPTIONS)}")


def _bounds(frames):
    if frames is None:
        return [0, 1]
    return [frames.start, frames.stop] if isinstance(frames, range) else [int(frames), int(frames) + 1]


def _refused(key, why):
    return InputError([(why, None, None, None, key)])
