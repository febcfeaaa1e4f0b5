"""What a run on a cluster sends, keeps and refuses: all of it that needs no Ray."""

import ast
import errno
import inspect
import os
import re
import resource
import shutil
import sys
import types

import pytest
from conftest import ROOT, contents

import etendue
from etendue.cluster import __main__ as command
from etendue.cluster import bundle, driver, store


# glTF with buffers and pictures beside it; a material library; lamps that were measured; base files, cameras and a trajectory.
@pytest.mark.parametrize("name", ["crates/cli/tests/jobs/small/small.toml", "scenes/gltf/gltf.toml", "scenes/drive/drive.toml"])
def test_a_bundle_is_all_that_a_job_needs_elsewhere(name, tmp_path, monkeypatch):
    monkeypatch.chdir(ROOT / "docs")
    here = os.path.relpath(ROOT / name)
    job = etendue.Job.open(here)
    sent = bundle.gather(here, job.files)
    assert len(sent.files) == len(job.files) and sent.job == (ROOT / name).relative_to("/").as_posix()
    assert len(bundle.open_copy(sent, {}, job.plan()["hash"]).files) == len(job.files)
    there = sent.write(tmp_path)
    assert contents(tmp_path).keys() == sent.files.keys()
    assert etendue.Job.open(there).plan()["hash"] == job.plan()["hash"]
    next(iter(sorted(tmp_path.rglob("*.obj")) or sorted(tmp_path.rglob("*.glb")))).unlink()
    with pytest.raises(etendue.InputError):
        etendue.Job.open(there)


def test_links_and_equal_files_are_sent_as_what_they_hold(tmp_path, monkeypatch):
    (tmp_path / "real/deep").mkdir(parents=True)
    (tmp_path / "job").mkdir()
    for name in ("real/a.obj", "real/deep/b.obj", "job/c.obj"):
        (tmp_path / name).write_text("v 0 0 0")
    (tmp_path / "job/linked").symlink_to(tmp_path / "real")
    (tmp_path / "job/job.toml").write_text("1")
    monkeypatch.chdir(tmp_path)
    paths = [bundle.Path(name) for name in ("job/job.toml", "job/linked/a.obj", "job/linked/deep/../deep/b.obj", "job/c.obj")]
    sent = bundle.gather("job/job.toml", paths)
    assert len(sent.contents) == 2
    away = tmp_path / "away"
    sent.write(away)
    for path in paths:
        assert (away / str(tmp_path)[1:] / path).read_bytes() == path.read_bytes()
    # Through the link .. is the folder of "real", where another a.obj lies than in "job".
    (tmp_path / "job/a.obj").write_text("v 1 1 1")
    (tmp_path / "a.obj").write_text("v 2 2 2")
    with pytest.raises(etendue.InputError, match="link"):
        bundle.gather("job/job.toml", [bundle.Path("job/a.obj"), bundle.Path("job/linked/../a.obj")])


@pytest.fixture
def absolute(tmp_path, monkeypatch):
    """A job in "small" of this folder that names a mesh below its own folder by an absolute path, and that path."""
    shutil.copytree(ROOT / "crates/cli/tests/jobs/small", tmp_path / "small")
    mesh = tmp_path / "small/tower.obj"
    file = tmp_path / "small/small.toml"
    file.write_text(re.sub(r'"tower\.obj"', f'"{mesh}"', file.read_text()))
    monkeypatch.chdir(tmp_path)
    return mesh


# Where the job is opened by an absolute path too, its list of files does not tell how they were named.
@pytest.mark.parametrize("folder", ["small", "{}/small", "{}/small/../small"])
def test_files_of_absolute_paths_are_refused(folder, absolute, tmp_path):
    folder = bundle.Path(folder.format(tmp_path))
    with pytest.raises(etendue.InputError, match="absolute path") as refused:
        *_, plan_hash, sent = driver._read(folder / "small.toml", None, {})
        bundle.open_copy(sent, {}, plan_hash)
    named = {fault.file for fault in refused.value.faults}
    assert str(absolute) in named and str(folder / "small.toml") not in named


def test_steps_above_the_root_are_refused(tmp_path, monkeypatch):
    (tmp_path / "mesh.obj").write_text("v 0 0 0")
    (tmp_path / "job.toml").write_text("1")
    monkeypatch.chdir(tmp_path)
    depth = len(tmp_path.parts) - 1
    root = [bundle.Path(*[".."] * count, str(tmp_path)[1:], "mesh.obj") for count in (depth, depth + 1)]
    assert all(path.read_text() for path in root)
    assert len(bundle.gather("job.toml", [bundle.Path("job.toml"), root[0]]).files) == 2
    with pytest.raises(etendue.InputError, match="above the root") as refused:
        bundle.gather("job.toml", [bundle.Path("job.toml"), *root])
    assert [fault.file for fault in refused.value.faults] == [str(root[1])]


def test_a_copy_that_is_another_job_is_not_rendered(tmp_path, monkeypatch):
    shutil.copytree(ROOT / "crates/cli/tests/jobs/small", tmp_path / "small")
    monkeypatch.chdir(tmp_path)
    job = etendue.Job.open("small/small.toml")
    sent = bundle.gather("small/small.toml", job.files)
    plan_hash = job.plan()["hash"]
    with pytest.raises(etendue.RunError, match="have changed"):
        bundle.open_copy(sent, {"spp": 3}, plan_hash)
    more = bundle.Bundle(sent.job, {**sent.files, "tmp/more": next(iter(sent.contents))}, sent.folders, sent.contents)
    with pytest.raises(etendue.RunError, match="have changed"):
        bundle.open_copy(more, {}, plan_hash)
    monkeypatch.setattr(bundle.tempfile, "tempdir", "/proc")
    with pytest.raises(etendue.RunError, match="cannot be made"):
        bundle.open_copy(sent, {}, plan_hash)


RUN = {"version": "1", "plan_hash": "ab", "frames": [0, 1], "shards": 2, "camera": None}


def opened(folder, run=RUN, names=("front/camera.json",), overwrite=False, resume=False):
    kept = store.Store(folder)
    kept.open(run, names, overwrite=overwrite, resume=resume)
    return kept


def test_what_is_finished_is_found_again_and_nothing_else(tmp_path):
    kept = opened(tmp_path)
    with pytest.raises(etendue.InputError, match="another run"):
        opened(tmp_path, resume=True)
    kept.add("front.film.exr", 1, {"front.film.exr": b"film", "shard.json": b"{}"})
    kept.close()
    with pytest.raises(etendue.InputError, match="--resume"):
        opened(tmp_path)
    for change in ({"shards": 3}, {"plan_hash": "cd"}, {"frames": [0, 2]}):
        with pytest.raises(etendue.InputError, match=next(iter(change))):
            opened(tmp_path, {**RUN, **change}, resume=True)
    again = opened(tmp_path, resume=True)
    assert [again.has("front.film.exr", shard) for shard in range(2)] == [False, True] and not again.has("rear.film.exr", 1)
    # A driver that was killed while it wrote.
    (tmp_path / ".cluster/shard-00000").mkdir()
    (tmp_path / ".cluster/shard-00000/front.film.exr.new").write_bytes(b"fi")
    assert not again.has("front.film.exr", 0)
    with pytest.raises(etendue.RunError, match="tile_px"):
        again.add("rear.film.exr", 1, {"rear.film.exr": b"film", "shard.json": b'{"tile_px": [8]}'})
    again.add("rear.film.exr", 1, {"rear.film.exr": b"film", "shard.json": b'{"request": {"job": "elsewhere"}}'})
    again.close()
    anew = opened(tmp_path, overwrite=True)
    assert not anew.has("front.film.exr", 1) and [path.name for path in anew.folder.iterdir()] == ["run.json"]
    anew.close()
    assert not tmp_path.exists(), "a run of which nothing is finished leaves nothing"


def test_a_driver_that_ends_meanwhile_leaves_its_folder_to_nobody(tmp_path, monkeypatch):
    """Another driver ends, with all that it kept, when this one has opened the folder and not locked it yet; then before it has opened it."""
    flock, mkdir, ended = store.fcntl.flock, store.Path.mkdir, []

    def ends(first):
        if not ended:
            ended.append(first)
            first.remove()

    first = opened(tmp_path)
    with monkeypatch.context() as meanwhile:
        meanwhile.setattr(store.fcntl, "flock", lambda *lock: (ends(first), flock(*lock)))
        second = opened(tmp_path)
    assert (tmp_path / ".cluster/run.json").is_file() and os.path.samestat(os.fstat(second._lock), os.stat(second.folder))
    first.close()
    assert second.folder.is_dir(), "who has ended removes nothing of the next"
    with monkeypatch.context() as meanwhile:
        ended.clear()
        meanwhile.setattr(store.Path, "mkdir", lambda path, **how: (mkdir(path, **how), ends(second)))
        third = opened(tmp_path, resume=True)
    assert (tmp_path / ".cluster/run.json").is_file(), "what the other kept is not taken for there"
    with pytest.raises(etendue.InputError, match="another run"):
        opened(tmp_path, resume=True)
    third.close()


def test_a_refused_driver_changes_nothing(tmp_path):
    kept = opened(tmp_path)
    kept._let_go()
    for more in ({}, {"run": {**RUN, "shards": 3}, "resume": True}):
        with pytest.raises(etendue.InputError):
            opened(tmp_path, **more)
    assert (tmp_path / ".cluster/run.json").is_file()
    opened(tmp_path, resume=True).close()
    assert not tmp_path.exists()


@pytest.mark.parametrize(("number", "told"), [("ENOLCK", "cannot be locked: No locks available"), ("EWOULDBLOCK", "another run")])
def test_why_a_folder_is_not_locked_is_said(number, told, tmp_path, monkeypatch):
    def refuse(*lock):
        raise OSError(getattr(errno, number), os.strerror(getattr(errno, number)))

    monkeypatch.setattr(store.fcntl, "flock", refuse)
    with pytest.raises(etendue.InputError, match=told):
        opened(tmp_path / "out")


def test_results_that_are_there_are_not_replaced_unasked(tmp_path):
    (tmp_path / "front").mkdir()
    (tmp_path / "front/camera.json").write_text("{}")
    for resume in (False, True):
        with pytest.raises(etendue.InputError, match="--overwrite"):
            opened(tmp_path, resume=resume)
    assert not (tmp_path / ".cluster").exists()
    (tmp_path / "file").write_text("")
    with pytest.raises(etendue.InputError, match="cannot be made"):
        opened(tmp_path / "file")
    (tmp_path / "out").mkdir()
    (tmp_path / "out/.cluster").write_text("")
    with pytest.raises(etendue.InputError, match="cannot be made: File exists"):
        opened(tmp_path / "out")
    assert (tmp_path / "front/camera.json").read_text() == "{}"


def test_a_store_that_cannot_be_written_is_a_run_that_failed(tmp_path):
    kept = opened(tmp_path)
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    # Files of three bytes at most.
    resource.setrlimit(resource.RLIMIT_FSIZE, (3, before[1]))
    try:
        with pytest.raises(etendue.RunError, match="File too large"):
            kept.add("front.film.exr", 0, {"front.film.exr": b"film", "shard.json": b"{}"})
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert not kept.has("front.film.exr", 0) and sorted(path.name for path in kept.folder.rglob("*.*")) == ["run.json", "shard.json"]
    kept.close()


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["x.toml", "--shards", "2"], "-o/--output"),
        (["x.toml", "-o", "out"], "--shards"),
        (["x.toml", "-o", "out", "--shards", "2", "--frames", "3..3"], "FIRST < END"),
        (["x.toml", "-o", "out", "--shards", "two"], "invalid int value"),
        (["x.toml", "-o", "out", "--shards", "2", "--overwrit"], "unrecognized"),
    ],
)
def test_arguments_that_are_wrong_end_with_status_2(arguments, told, capsys):
    with pytest.raises(SystemExit) as ended:
        command.main(arguments)
    assert ended.value.code == 2 and told in capsys.readouterr().err


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (["--shards", "0"], "--shards 0: expected a whole number from 1 to 65536"),
        (["--shards", "2", "--retries", "-1"], "--retries -1"),
        (["--shards", "2", "--threads", "0"], "--threads 0"),
        (["--shards", "2", "--spp", "-1"], "--spp -1: expected a whole number from 1"),
        (["--shards", "2", "--seed", "9223372036854775808"], "--seed"),
        (["--shards", "2", "--resume", "--overwrite"], "exclude one another"),
    ],
)
def test_values_that_are_wrong_are_refused_before_anything(more, told, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(command.importlib.util, "find_spec", lambda name: True)
    assert command.main(["no/such/job.toml", "-o", str(tmp_path / "out"), *more]) == 2
    assert told in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_without_ray_it_says_how_to_get_it(monkeypatch, capsys):
    monkeypatch.setattr(command.importlib.util, "find_spec", lambda name: None)
    assert command.main(["x.toml", "-o", "out", "--shards", "2"]) == 2
    assert "[cluster]" in capsys.readouterr().err


@pytest.mark.parametrize("address", ["ray://a:1", "a", "127.0.0.1:1", "127.0.0.1:99999999"])
def test_addresses_without_a_cluster_are_refused_at_once(address):
    with pytest.raises(etendue.InputError, match="--address"):
        driver._check_answers(address)


def test_what_fails_on_a_worker_is_a_run_that_failed():
    class RayError(Exception):
        pass

    class RayTaskError(RayError):
        cause = OSError(28, "No space left on device")

    def lost(reference):
        raise reference

    ray = types.SimpleNamespace(exceptions=types.SimpleNamespace(RayError=RayError, RayTaskError=RayTaskError), get=lost)
    tasks = driver._Tasks(ray, None, 3, None)
    refused, failed = RayTaskError(), RayTaskError()
    refused.cause = etendue.InputError([("job.toml: changed", None, None, None, None)])
    for error, expected, told in [
        (failed, etendue.RunError, "front.film.exr, shard 1: a worker failed .OSError: .* No space left"),
        (refused, etendue.InputError, "job.toml: changed"),
        (RayError("the node died\nlong story"), etendue.RunError, "lost 4 times .RayError: the node died.; go on with --resume"),
    ]:
        with pytest.raises(expected, match=told):
            tasks._got(error, "front.film.exr", 1)
    gone = types.SimpleNamespace(told=types.SimpleNamespace(remote=lambda: RayError("The actor died\nlong story")))
    with pytest.raises(etendue.RunError, match="progress was lost .RayError: The actor died.; go on with --resume"):
        tasks._so_far(gone, {}, 1)
    ray.get = lambda reference: reference
    with pytest.raises(etendue.RunError, match="front.film.exr, shard 1: its worker gave up"):
        tasks._got({}, "front.film.exr", 1)


def test_the_page_names_every_option_and_its_python_is_that_of_the_package():
    page = (ROOT / "docs/cluster.md").read_text()
    options = [word for action in command.parser()._actions for word in action.option_strings if word.startswith("--")]
    assert len(options) == 16 and all(f"`{word}" in page for word in options if word not in ("--help", "--output"))
    (block,) = re.findall(r"```python\n(.*?)```", page, re.S)
    called = next(node for node in ast.walk(ast.parse(block)) if isinstance(node, ast.Call) and ast.unparse(node.func) == "etendue.cluster.render")
    inspect.signature(driver.render).bind(*called.args, **{keyword.arg: keyword.value for keyword in called.keywords})


def test_options_of_other_verbs_are_no_options_here():
    with pytest.raises(TypeError, match="time_s"):
        driver.render("x.toml", "out", shards=1, time_s=10)
    assert "ray" not in sys.modules


def test_nothing_is_removed_or_written_through_a_link(tmp_path):
    foreign = tmp_path / "foreign"
    foreign.mkdir()
    (foreign / "theirs").write_text("precious")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / store.FOLDER).symlink_to(foreign)
    for options in ({"overwrite": True, "resume": False}, {"overwrite": False, "resume": True}, {"overwrite": False, "resume": False}):
        with pytest.raises(etendue.InputError, match="a symbolic link is in the place"):
            store.Store(tmp_path / "out").open({}, [], **options)
    assert contents(foreign) == {"theirs": b"precious"}
    (tmp_path / "out" / store.FOLDER).unlink()
    kept = store.Store(tmp_path / "out")
    kept.open({"a": 1}, [], overwrite=False, resume=False)
    (tmp_path / "out" / store.FOLDER / "shard-00000").symlink_to(foreign)
    with pytest.raises(etendue.InputError, match="a symbolic link is in the place"):
        kept.add("x.film.exr", 0, {store.MANIFEST: b"{}", "x.film.exr": b""})
    kept.close()
    again = store.Store(tmp_path / "out")
    again.open({"a": 2}, [], overwrite=True, resume=False)
    again.close()
    assert contents(foreign) == {"theirs": b"precious"}
