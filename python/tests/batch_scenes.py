"""Many small scenes for the tests of batches, and ways to run ``crashrank-batch``."""

import contextlib
import io
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

import crashrank
from conftest import DATA


def scene(i: int = 0, **more) -> dict:
    """Return a scene that takes some ten milliseconds: a car, a pole and another car."""
    return {
        "scenario_version": 2,
        "name": f"scene {i}",
        "models": {
            "car": {"mesh": "models/car.crm", "kind": "car", "mass_kg": 1200},
            "pole": {"mesh": "models/pole.crm", "kind": "pole"},
        },
        "ego": {"model": "car", "speed_mps": 14 + 0.25 * (i % 40)},
        "candidates": {
            "listed": [
                {"name": "brake", "acceleration_mps2": -7},
                {"name": "left", "acceleration_mps2": -3, "steering_deg": 2 + 0.05 * (i % 7)},
            ],
            "grid": False,
        },
        "actors": [
            {"name": "pole", "model": "pole", "pose": {"x_m": 14 + 0.1 * (i % 11), "y_m": 0.2}},
            {
                "name": "car",
                "model": "car",
                "pose": {"x_m": 25, "y_m": 2.5, "yaw_deg": 180},
                "speed_mps": 8 + 0.5 * (i % 5),
            },
        ],
        "horizon_s": 2,
        "measure": "delta-v",
        **more,
    }


def make_models(folder: pathlib.Path) -> None:
    """Write the compiled models that the scenes name."""
    (folder / "models").mkdir(parents=True)
    for name, mesh in (("car", "hatch.obj"), ("pole", "pole.obj")):
        crashrank.load_model(DATA / "models" / mesh).save(folder / "models" / f"{name}.crm")


def write_scene(folder: pathlib.Path, name: str, document: dict | str) -> pathlib.Path:
    text = document if isinstance(document, str) else json.dumps(document)
    path = folder / f"{name}.json"
    path.write_text(text, encoding="utf-8")
    return path


def make_folder(folder: pathlib.Path, count: int) -> pathlib.Path:
    """Return a new folder of scenes and their models."""
    make_models(folder)
    for i in range(count):
        write_scene(folder, f"scene-{i:02}", scene(i))
    return folder


def results(folder: pathlib.Path) -> list[tuple]:
    """Return id, status and result of every row, by way of the folder as one data set."""
    import pyarrow.parquet as pq

    table = pq.read_table(folder)
    columns = [table.column(name).to_pylist() for name in ("id", "status", "result_hash")]
    return sorted(zip(*columns, strict=True), key=str)


def parts(folder: pathlib.Path) -> dict[str, tuple[int, int]]:
    """Return name, inode and time of change of every part."""
    found = sorted(folder.glob("part-*.parquet"))
    return {each.name: (each.stat().st_ino, each.stat().st_mtime_ns) for each in found}


def write_table(path: pathlib.Path, documents: list, ids: list | None = None, **columns) -> None:
    """Write a table of scenarios; ids are those of `make_folder` unless given."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    texts = [each if isinstance(each, str) else json.dumps(each) for each in documents]
    named = [f"scene-{i:02}.json" for i in range(len(texts))] if ids is None else ids
    pq.write_table(pa.table({"id": named, "scenario": texts, **columns}), path)


def make_hook(folder: pathlib.Path, code: str) -> dict[str, str]:
    """Return the environment in which every process of a run executes the code as it starts."""
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(code)
    return {"PYTHONPATH": str(folder)}


def one_line(done: subprocess.CompletedProcess) -> str:
    """Return the message of a run that ended with one line, which has a remedy."""
    assert "Traceback" not in done.stderr
    assert len(done.stderr.splitlines()) == 1, done.stderr
    return done.stderr


def environment(**more: str) -> dict[str, str]:
    """Return the environment of a run; PYTHONPATH entries are prepended."""
    env = {**os.environ, **more}
    if "PYTHONPATH" in more:
        env["PYTHONPATH"] = os.pathsep.join([more["PYTHONPATH"], os.environ.get("PYTHONPATH", "")])
    return env


def command(*words: object) -> list[str]:
    return [sys.executable, "-m", "crashrank.batch", *map(str, words)]


def run_batch(*words: object, code: int = 0, **more: str) -> dict:
    """Run the program to its end; return its outcome, with what it printed as ``messages``.

    Without workers and an environment of its own it runs in this process.
    """
    reports = () if "--reports" in words else ("--reports", 0)
    given = [*map(str, words), *map(str, reports), "--json"]
    run = run_here if "--sequential" in words and not more else run_there
    found, printed, messages = run(given, more)
    assert found == code, (found, printed, messages)
    outcome = json.loads(printed) if printed else {}
    return outcome | {"messages": messages}


def run_here(words: list[str], _more: dict[str, str]) -> tuple[int, str, str]:
    from crashrank.batch._command import main

    before = signal.getsignal(signal.SIGTERM)
    printed, messages = io.StringIO(), io.StringIO()
    try:
        with contextlib.redirect_stdout(printed), contextlib.redirect_stderr(messages):
            code = main(words)
    finally:
        signal.signal(signal.SIGTERM, before)
    return code, printed.getvalue(), messages.getvalue()


def run_there(words: list[str], more: dict[str, str]) -> tuple[int, str, str]:
    done = subprocess.run(
        command(*words), capture_output=True, text=True, check=False, timeout=300,
        env=environment(**more),
    )  # fmt: skip
    return done.returncode, done.stdout, done.stderr


@contextlib.contextmanager
def running(*words: object, **more: str):
    """Start the program; what is left of it in the end is killed."""
    process = subprocess.Popen(
        command(*words), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        env=environment(**more), start_new_session=True,
    )  # fmt: skip
    try:
        yield process
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


def wait_for_parts(folder: pathlib.Path, count: int, seconds: float = 120) -> list[pathlib.Path]:
    """Return the parts of a folder once there are so many."""
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        parts = sorted(folder.glob("part-*.parquet"))
        if len(parts) >= count:
            return parts
        time.sleep(0.02)
    raise AssertionError(f"{count} parts were not there within {seconds} s")


def children(process: int) -> list[int]:
    """Return the processes that a process has started."""
    found = []
    for each in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            fields = each.read_text().rpartition(")")[2].split()
            if int(fields[1]) == process:
                found.append(int(each.parent.name))
    return found


def worker_processes(process: int) -> list[int]:
    """Return the spawned workers of a run."""
    found = []
    for each in children(process):
        with contextlib.suppress(OSError):
            if b"spawn_main" in pathlib.Path(f"/proc/{each}/cmdline").read_bytes():
                found.append(each)
    return found


def wait_until_gone(processes: list[int], seconds: float = 60) -> None:
    """Return once none of these processes is left."""
    end = time.monotonic() + seconds
    while left := [each for each in processes if pathlib.Path(f"/proc/{each}").exists()]:
        assert time.monotonic() < end, f"processes {left} are left"
        time.sleep(0.02)
