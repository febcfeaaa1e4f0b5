"""While a run takes its time: progress, cancelling, other threads, and what is told."""

import os
import signal
import threading
import time

import pytest
from conftest import JOB
from test_made_in_python import described, sheet

import etendue


def test_progress_is_told_in_the_calling_thread(job):
    told = []
    job.render(progress=lambda heading, done, total: told.append((heading, done, total, threading.get_ident())))
    assert told and told[-1][1] == told[-1][2]
    assert {thread for *_, thread in told} == {threading.get_ident()}
    assert all(isinstance(heading, str) for heading, *_ in told)


def test_what_the_progress_function_raises_cancels():
    class Enough(Exception):
        pass

    calls = []

    def stop(*told):
        calls.append(told)
        raise Enough

    begun = time.monotonic()
    # Hundreds of tiles of a second each: it is told of the first.
    large = {"cameras.front.sensor.width_px": 460, "cameras.front.sensor.height_px": 300}
    with pytest.raises(Enough):
        etendue.Job.open(JOB, spp=1000, set=large).render(progress=stop)
    assert time.monotonic() - begun < 60 and len(calls) == 1


@pytest.fixture
def interruptible():
    """Ctrl-C as Python has it in a terminal: a shell's background jobs are started with it ignored."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def test_ctrl_c_cancels_while_other_threads_run(tmp_path, interruptible):
    ticks, stopped = [], threading.Event()

    def tick():
        while not stopped.wait(0.01):
            ticks.append(1)

    ticking = threading.Thread(target=tick)
    ticking.start()
    threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
    begun = time.monotonic()
    try:
        with pytest.raises(KeyboardInterrupt):
            etendue.Job.open(JOB, spp=200_000).save(tmp_path / "out")
    finally:
        stopped.set()
        ticking.join()
    # Half a second until the signal; a run without cancelling would take minutes, and with the lock held nothing would tick.
    assert time.monotonic() - begun < 30 and len(ticks) > 5
    assert not list((tmp_path / "out").rglob("*.exr"))


def test_notes_go_to_logging(caplog):
    with caplog.at_level("INFO", logger="etendue"):
        etendue.Job.open(JOB, noise=0.5)
    assert any("overrides" in record.message for record in caplog.records)


def test_warnings_go_to_warnings(tmp_path):
    with pytest.warns(UserWarning, match="there is no light"):
        etendue.Job.open(described(environment=None), meshes={"sheet.obj": sheet()}).save(tmp_path)


def test_the_number_of_threads_does_not_change_bits(results):
    one = etendue.Job.open(JOB).render(threads=1)
    assert (one.cameras[0].raw == results.cameras[0].raw).all()
    with pytest.raises(etendue.InputError, match="threads"):
        etendue.Job.open(JOB).render(threads=0)


@pytest.mark.parametrize("scale", ["1/2", 0.5])
def test_a_scale_has_fewer_larger_pixels(scale):
    size = {"cameras.front.sensor.width_px": 48, "cameras.front.sensor.height_px": 32}
    full, half = (etendue.Job.open(JOB, set=size, scale=of).plan()["cameras"][0] for of in (None, scale))
    assert half["sensor_px"] == [side // 2 for side in full["sensor_px"]] and (full["scale"], half["scale"]) == (1.0, 0.5)
    with pytest.raises(etendue.InputError, match="`scale` 1/7"):
        etendue.Job.open(JOB, set=size, scale="1/7")
