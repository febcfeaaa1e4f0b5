"""Runs on Ray: two nodes, one of them killed, and a driver that is killed. The bytes are those of one machine."""

import os
import re
import signal
import subprocess
import sys
import time

import pytest
from conftest import JOB, contents

import etendue
import etendue.cluster
from etendue.cluster import __main__ as command
from etendue.cluster import driver

ray = pytest.importorskip("ray")
pytestmark = pytest.mark.cluster

# A task of these takes some seconds, so that some are under way at any time and tell their progress.
SPP = 2400
# Many tiles a task, so that its progress is told; no bit depends on it.
FINE = {"render.tile_px": 8}
MORE = """
[sequence]
frame_rate_hz = 10

[[scene.objects]]
name = "mover"
shape = { type = "sphere", radius_m = 0.2 }
material = "gold"
keys = [{ time_s = 0, position_m = [4, 0, 0.2] }, { time_s = 1, position_m = [4, 2, 0.2] }]

[[cameras]]
name = "side"
position_m = [5, -4, 1]
look_at_m = [5, 0, 0.5]
lens = { type = "pinhole", focal_length_mm = 5, f_number = 4 }
sensor = { width_px = 40, height_px = 30, pixel_pitch_um = 120 }
output = { raw = false, electrons = false, picture = false }
"""


@pytest.fixture
def moving(tmp_path):
    """A job of two cameras and two frames that builds on another in another folder."""
    folder = tmp_path / "job"
    folder.mkdir()
    (folder / "job.toml").write_text(f'format = 1\nbase = "{os.path.relpath(JOB, folder)}"\n{MORE}')
    return folder / "job.toml"


@pytest.fixture
def nodes():
    """Two nodes of one processor each beside the driver's, which has none."""
    from ray.cluster_utils import Cluster

    small = {"object_store_memory": 100_000_000}
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, **small})
    workers = [cluster.add_node(num_cpus=1, **small) for _ in range(2)]
    cluster.wait_for_nodes()
    ray.init(address=cluster.address, log_to_driver=False, logging_level="error")
    yield cluster, workers
    ray.shutdown()
    cluster.shutdown()


def on_one_machine(job, folder, **options):
    etendue.Job.open(job, **options).save(folder, frames=range(0, 2))
    return contents(folder)


def test_a_node_that_is_killed_changes_no_byte(moving, tmp_path, nodes, monkeypatch):
    cluster, (lost, _) = nodes
    looks, under_way = [], {}
    so_far = driver._Tasks._so_far

    def look(tasks, progress, pending, total):
        told = ray.get(progress.told.remote())
        left = {task: told[task][1] for task in pending.values() if task in told}
        if not under_way and len(pending) < total and lost.node_id in left.values():
            under_way.update({task: node for task, node in left.items() if node == lost.node_id})
            cluster.remove_node(lost, allow_graceful=False)
        looks.append((told, so_far(tasks, progress, pending, total)))
        return looks[-1][1]

    monkeypatch.setattr(driver._Tasks, "_so_far", look)
    told = []
    out = tmp_path / "out"
    etendue.cluster.render(moving, out, shards=3, frames=range(0, 2), spp=SPP, set=FINE, progress=lambda *step: told.append(step))
    last, _ = looks[-1]
    assert under_way, "the node was killed while it rendered"
    assert all(last[task][1] != lost.node_id for task in under_way), "what it rendered was rendered by the other"
    assert contents(out) == on_one_machine(moving, tmp_path / "one", spp=SPP)
    tasks = [step for step in told if step[0] == "tasks"]
    # Two cameras, two frames, three shards; a node that is lost takes back what it told.
    assert tasks[-1][1:] == (12, 12) and any(not float(done).is_integer() for _, done, _ in tasks)


def test_a_worker_process_that_is_killed_is_replaced(moving, tmp_path, nodes, monkeypatch):
    with monkeypatch.context() as other:
        other.setattr(driver, "__version__", "0.0.1")
        with pytest.raises(etendue.RunError, match="version .* and the driver 0.0.1"):
            etendue.cluster.render(moving, tmp_path / "out", shards=2)
    assert not (tmp_path / "out").exists()
    steps = []

    def give_up(*step):
        steps.append(step)
        if len(steps) == 20:
            raise TimeoutError

    # Tasks of many minutes.
    with pytest.raises(TimeoutError):
        etendue.cluster.render(moving, tmp_path / "out", shards=8, spp=400 * SPP, progress=give_up)
    deadline = time.monotonic() + 30
    while ray.available_resources().get("CPU", 0) < 2:
        assert time.monotonic() < deadline, "tasks of a run that was cancelled end, in a cluster that goes on"
        time.sleep(0.2)
    killed = []

    def kill_one(what, done, total):
        if not killed and what == "tasks" and done > 1:
            found = subprocess.run(["pgrep", "-f", "^ray::render_film"], capture_output=True, text=True).stdout.split()
            ours = [int(pid) for pid in found if descends_from(int(pid), os.getpid())]
            if ours:
                os.kill(ours[0], signal.SIGKILL)
                killed.append(ours[0])

    out = tmp_path / "out"
    etendue.cluster.render(moving, out, shards=2, frames=range(0, 2), spp=SPP, progress=kill_one)
    assert killed and contents(out) == on_one_machine(moving, tmp_path / "one", spp=SPP)


def descends_from(process, ancestor):
    while process > 1:
        if process == ancestor:
            return True
        process = int(open(f"/proc/{process}/stat").read().rsplit(")", 1)[1].split()[1])
    return False


def test_a_driver_that_is_killed_goes_on_where_it_was(moving, tmp_path):
    out = tmp_path / "out"
    command = [sys.executable, "-m", "etendue.cluster", str(moving), "-o", str(out), "--shards", "4", "--frames", "0..2", "--spp", str(SPP)]
    films = lambda: list(out.glob(".cluster/shard-*/*.film.exr"))

    def ended_by(number, count, *more):
        """Sends a signal when so many films are finished."""
        driver = subprocess.Popen([*command, *more], stderr=subprocess.PIPE, text=True, preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL))
        deadline = time.monotonic() + 120
        while len(films()) < count:
            assert driver.poll() is None and time.monotonic() < deadline, "it renders"
            time.sleep(0.05)
        driver.send_signal(number)
        return driver.communicate()[1], driver.returncode

    told, status = ended_by(signal.SIGINT, 1)
    assert status == 130 and "--resume" in told and "Traceback" not in told, told
    assert ended_by(signal.SIGKILL, 4, "--resume")[1] == -signal.SIGKILL
    kept = {path: path.stat().st_mtime_ns for path in films()}
    assert 4 <= len(kept) < 16 and contents(out).keys() == {name for name in contents(out) if name.startswith(".cluster")}
    unasked = subprocess.run(command, capture_output=True, text=True)
    assert unasked.returncode == 2 and "--resume" in unasked.stderr
    again = subprocess.run([*command, "--resume"], capture_output=True, text=True)
    assert again.returncode == 0, again.stderr
    steps = [float(done) for done in re.findall(r"^tasks ([\d.]+)/16$", again.stderr, re.M)]
    assert steps and steps[0] >= len(kept), "what was finished is not rendered again"
    assert contents(out) == on_one_machine(moving, tmp_path / "one", spp=SPP)
    assert set(again.stdout.splitlines()) == {str(out / name) for name in contents(out)}


def test_a_process_of_progress_that_dies_is_a_run_that_failed(moving, tmp_path, monkeypatch, capsys):
    so_far, out = driver._Tasks._so_far, tmp_path / "out"

    def kill_and_look(tasks, progress, pending, total):
        ray.kill(progress)
        return so_far(tasks, progress, pending, total)

    monkeypatch.setattr(driver._Tasks, "_so_far", kill_and_look)
    # Tasks of many minutes.
    assert command.main([str(moving), "-o", str(out), "--shards", "2", "--spp", str(400 * SPP)]) == 1
    told = capsys.readouterr().err
    assert "error: the process that gathers progress was lost (ActorDiedError" in told and "--resume" in told and not out.exists()


def test_what_is_wrong_is_said_with_the_status_of_the_program(moving, tmp_path):
    absolute = moving.with_name("absolute.toml")
    absolute.write_text(f'format = 1\nbase = "{moving}"\n')

    def ended(*more):
        command = [sys.executable, "-m", "etendue.cluster", *more, "--shards", "2", "-o", str(tmp_path / "out")]
        done = subprocess.run(command, capture_output=True, text=True)
        assert not (tmp_path / "out/.cluster").exists() or "--threads" in more
        return done.returncode, done.stderr

    for arguments, told in [
        ([str(tmp_path / "none.toml")], "none.toml"),
        ([str(moving), "--set", "render.sp=4"], "render.sp"),
        ([str(moving), "--quality", "best"], "draft"),
        ([str(absolute)], f"{moving}: it is named by an absolute path"),
        ([str(moving), "--threads", "1000"], "--threads 1000: the largest machine"),
    ]:
        status, text = ended(*arguments)
        assert status == 2 and told in text and "Traceback" not in text, (arguments, text)
