"""Runs of ``crashrank-batch`` that something ends: signals, killed workers, a full disk."""

import json
import os
import pathlib
import re
import resource
import signal
import subprocess
import time

import pytest
from batch_scenes import (
    command,
    make_hook,
    one_line,
    parts,
    results,
    run_batch,
    running,
    scene,
    wait_for_parts,
    wait_until_gone,
    worker_processes,
    write_scene,
)

pa = pytest.importorskip("pyarrow")
pq = pytest.importorskip("pyarrow.parquet")


@pytest.fixture
def slow(scenes):
    """Return a folder of many scenes that take longer: every measure is simulated."""
    for i in range(12, 36):
        write_scene(scenes, f"scene-{i:02}", scene(i, measure="harm"))
    return scenes


def test_a_run_that_was_killed_is_resumed(slow, tmp_path):
    out = tmp_path / "out"
    words = (slow, "-o", out, "--workers", 2, "--rows-per-part", 2)
    with running(*words) as run:
        wait_for_parts(out, 4)
        workers = worker_processes(run.pid)
        run.kill()  # SIGKILL: it cleans nothing up
        run.wait()
        wait_until_gone(workers)
    there = parts(out)
    assert 4 <= len(there) < 18
    resumed = run_batch(*words)
    assert resumed["found_rows"] == 2 * len(there)
    assert set(there.items()) <= set(parts(out).items())
    assert resumed["results"] == run_batch(slow, "-o", tmp_path / "b", "--sequential")["results"]
    assert not list(out.glob(".*.part"))


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize("how", [("--workers", 2), ("--sequential",)])
def test_an_interrupt_leaves_a_folder_to_resume(slow, tmp_path, how, sign):
    out = tmp_path / "out"
    words = (slow, "-o", out, *how, "--rows-per-part", 2)
    with running(*words) as run:
        wait_for_parts(out, 3)
        workers = worker_processes(run.pid)
        # As a terminal does: to all processes of the group.
        os.killpg(run.pid, sign) if sign == signal.SIGINT else run.send_signal(sign)
        began = time.monotonic()
        printed, messages = run.communicate(timeout=30)
        assert run.returncode == 4, messages
        assert "Traceback" not in messages
        assert "the same command continues" in messages
        assert "of 36 scenes" in printed
        assert time.monotonic() - began < 20
        wait_until_gone(workers, 5)
    assert "Not complete" in (out / "_summary.html").read_text()
    assert not json.loads((out / "_run.json").read_text())["complete"]
    there = parts(out)
    done = run_batch(slow, "-o", out, "--workers", 2)
    assert done["found_rows"] == 2 * len(there)
    assert done["errors"] == 0
    assert json.loads((out / "_run.json").read_text())["complete"]


def test_a_killed_worker_is_replaced(slow, tmp_path):
    out = tmp_path / "out"
    with running(slow, "-o", out, "--workers", 2, "--rows-per-part", 4) as run:
        wait_for_parts(out, 1)
        workers = worker_processes(run.pid)
        assert len(workers) == 2
        assert all(blocks(worker, signal.SIGINT) for worker in workers)
        os.kill(workers[0], signal.SIGKILL)
        printed, messages = run.communicate(timeout=120)
        assert run.returncode == 0, messages
        assert "a worker ended in part" in messages
        assert "signal 9" in messages
    reference = run_batch(slow, "-o", tmp_path / "b", "--sequential")
    assert reference["results"] in printed
    assert results(out) == results(tmp_path / "b")


def blocks(process, sign):
    """Return whether a process never sees a signal."""
    status = pathlib.Path(f"/proc/{process}/status").read_text()
    return bool(int(re.search(r"^SigBlk:\s*(\w+)", status, re.MULTILINE)[1], 16) >> sign - 1 & 1)


KILLER = """
import os, sys
from crashrank.batch import _worker
rank_scene = _worker.rank_scene
def rank_it(scene, settings):
    if scene.id == "scene-04.json":
        os.kill(os.getpid(), 9)
    return rank_scene(scene, settings)
_worker.rank_scene = rank_it
"""


def test_a_row_that_kills_its_workers_is_named(scenes, tmp_path):
    hook = make_hook(tmp_path / "hook", KILLER)
    out = tmp_path / "out"
    words = (scenes, "-o", out, "--workers", 2, "--rows-per-part", 4)
    done = run_batch(*words, **hook)
    assert (done["complete"], done["errors"]) == (True, 1)
    rows = {row["id"]: row for row in pq.read_table(out).to_pylist()}
    row = rows["scene-04.json"]
    assert (row["status"], row["error_code"]) == ("error", "internal")
    assert "ended its worker 2 times (signal 9)" in row["error"]
    assert sum(each["status"] == "ok" for each in rows.values()) == 11
    # The part stands; asked to, a run without the fault tries that row again.
    assert run_batch(*words)["found_rows"] == 12
    mended = run_batch(*words, "--retry")
    assert (mended["found_rows"], mended["errors"]) == (8, 0)


DEFECT = """
from crashrank.batch import _worker
def rank_row(*_):
    raise KeyError("planted")
_worker.rank_row = rank_row
"""


def test_a_defect_ends_the_run_and_says_so(scenes, tmp_path):
    hook = make_hook(tmp_path / "hook", DEFECT)
    done = run_batch(scenes, "-o", tmp_path / "out", code=1, **hook)
    assert "KeyError: 'planted'" in done["messages"]
    assert len(done["messages"].splitlines()) == 1


def test_workers_that_cannot_start_end_the_run(scenes, tmp_path):
    code = "import os, sys\nif '--multiprocessing-fork' in sys.argv: os._exit(7)\n"
    hook = make_hook(tmp_path / "hook", code)
    done = run_batch(scenes, "-o", tmp_path / "out", code=1, **hook)
    assert "exit code 7" in done["messages"]
    assert "--sequential" in done["messages"]


def limited(*words, bytes_a_file):
    """Run with a limit on the size of files, as a full disk is one."""

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_a_file, bytes_a_file))

    return subprocess.run(
        command(*words), capture_output=True, text=True, check=False, preexec_fn=limit
    )  # fmt: skip


@pytest.mark.parametrize("how", [("--workers", 2), ("--sequential",)])
def test_a_full_disk_is_one_line_and_loses_nothing(scenes, tmp_path, how):
    out = tmp_path / "out"
    first = run_batch(scenes, "-o", tmp_path / "all", "--rows-per-part", 1)
    size = max(each.stat().st_size for each in (tmp_path / "all").glob("part-*.parquet"))
    for i in range(2):
        write_scene(scenes, f"scene-{20 + i}", scene(i))
    run_batch(scenes, "-o", out, "--sequential", "--rows-per-part", 2)
    before = parts(out)
    for name in list(before)[3:]:
        (out / name).unlink()
    done = limited(scenes, "-o", out, *how, bytes_a_file=size // 2)
    assert done.returncode == 1
    message = one_line(done)
    assert "cannot be written: File too large" in message
    assert "make room" in message
    assert "scenes are done and stay" in message
    assert not list(out.glob(".*.part"))
    assert set(parts(out).items()) == set(list(before.items())[:3])
    assert first["rows"] == 12
    assert run_batch(scenes, "-o", out, "--sequential")["found_rows"] == 6


def test_two_runs_do_not_write_one_folder(slow, tmp_path):
    out = tmp_path / "out"
    with running(slow, "-o", out, "--sequential", "--rows-per-part", 2):
        wait_for_parts(out, 1)
        done = run_batch(slow, "-o", out, code=2)
    assert "another run writes" in done["messages"]


@pytest.mark.parametrize("name", ["_lock", "_run.json", "_summary.html"])
def test_a_folder_in_the_place_of_a_file_is_one_line(scenes, tmp_path, name):
    (tmp_path / "out" / name / "full").mkdir(parents=True)
    done = run_batch(
        scenes, "-o", tmp_path / "out", "--sequential", code=2 if name == "_lock" else 1
    )
    assert name in done["messages"] or name == "_lock"
    assert "cannot be written: Is a directory" in done["messages"]
    assert len(done["messages"].splitlines()) == 1


@pytest.mark.parametrize("how", [("--workers", 1), ("--sequential",)])
@pytest.mark.parametrize("name", ["_reports", "_stale"])
def test_a_file_in_the_place_of_a_folder_is_one_line(scenes, tmp_path, name, how):
    out = tmp_path / "out"
    run_batch(scenes, "-o", out, "--sequential")
    (out / name).touch()
    words = (scenes, "-o", out, *how, "--measure", "energy", "--reports", 1)
    done = run_batch(*words, code=1)
    assert f"{out / name}: cannot be written: File exists" in done["messages"]
    assert len(done["messages"].splitlines()) == 1
    (out / name).unlink()
    assert run_batch(*words)["complete"]


def test_a_second_interrupt_changes_no_exit_code(slow, tmp_path):
    out = tmp_path / "out"
    with running(slow, "-o", out, "--workers", 2, "--rows-per-part", 2) as run:
        wait_for_parts(out, 1)
        workers = worker_processes(run.pid)
        while run.poll() is None:
            os.killpg(run.pid, signal.SIGINT)
            time.sleep(0.02)
        _, messages = run.communicate(timeout=30)
        assert run.returncode == 4, messages
        assert len(messages.splitlines()) == 1, messages
        wait_until_gone(workers, 5)
    assert run_batch(slow, "-o", out, "--workers", 2)["complete"]


def test_closed_and_full_streams_are_no_traceback(scenes, tmp_path):
    words = " ".join(command(scenes, "-o", tmp_path / "out", "--sequential", "--reports", 0))
    for streams, code, message in (
        (">/dev/full", 1, "standard output: cannot be written: No space left"),
        ("2>&-", 0, ""),
    ):
        done = subprocess.run(
            f"{words} {streams}", shell=True, capture_output=True, text=True, check=False
        )
        assert done.returncode == code, done.stderr
        assert message in done.stderr
        assert "Traceback" not in done.stderr
