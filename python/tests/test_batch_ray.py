"""``crashrank-batch --engine ray``: on this machine, and on a cluster of two nodes.

Needs Ray, in an environment of its own: ``scripts/ray`` makes it and runs these tests.
"""

import contextlib
import importlib.util
import os
import pathlib
import secrets
import signal
import socket
import subprocess
import sys
import time
from typing import NamedTuple

import pytest
from batch_scenes import (
    environment,
    make_folder,
    run_batch,
    running,
    scene,
    wait_for_parts,
    write_scene,
)

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("ray") is None, reason="Ray is not installed: see scripts/ray"
)

# A token of its own for every run of the tests: nobody else can use their cluster.
QUIET = {
    "RAY_USAGE_STATS_ENABLED": "0",
    "RAY_AUTH_MODE": "token",
    "RAY_AUTH_TOKEN": secrets.token_hex(32),
}


class Cluster(NamedTuple):
    """Where a cluster is, and the processes of its nodes."""

    address: str
    nodes: list

    @property
    def options(self):
        return "--engine", "ray", "--address", self.address

    def actors(self):
        """Return the processes of the program's actors."""
        started = [each for node in self.nodes for each in descendants(node.pid)]
        return [each for each in started if b"ray::Worker" in command_line(each)]


def command_line(process):
    with contextlib.suppress(OSError):
        return pathlib.Path(f"/proc/{process}/cmdline").read_bytes()
    return b""


@pytest.fixture(scope="module")
def cluster():
    """Yield the address of a head and a second node: processes of their own on loopback."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    address = f"127.0.0.1:{port}"
    ray = [sys.executable, "-m", "ray.scripts.scripts", "start", "--block", "--num-cpus=1",
           "--disable-usage-stats"]  # fmt: skip
    nodes = []
    try:
        for where in (
            [
                f"--port={port}",
                "--head",
                "--node-ip-address=127.0.0.1",
                "--include-dashboard=false",
            ],
            [f"--address={address}"],
        ):
            nodes.append(
                subprocess.Popen(
                    [*ray, *where], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                    env=environment(**QUIET), start_new_session=True,
                )
            )  # fmt: skip
            wait_for_nodes(nodes, address)
        yield Cluster(address, nodes)
    finally:
        for node in reversed(nodes):
            stop_node(node)


def wait_for_nodes(nodes, address):
    """Wait until the cluster has all nodes that were started."""
    end = time.monotonic() + 180
    while count_nodes(address) < len(nodes):
        assert nodes[-1].poll() is None, f"the node ended with {nodes[-1].returncode}"
        assert time.monotonic() < end, "the cluster did not come up"


def count_nodes(address):
    code = (
        "import ray, sys\n"
        f"ray.init('{address}', logging_level='CRITICAL', log_to_driver=False)\n"
        "print(sum(node['Alive'] for node in ray.nodes()))\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=False,
        env=environment(**QUIET),
    )  # fmt: skip
    return int(done.stdout) if done.returncode == 0 else 0


def descendants(process):
    """Return a process and everything that it has started, those of own sessions included."""
    parents = {}
    for each in pathlib.Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            fields = each.read_text().rpartition(")")[2].split()
            parents.setdefault(int(fields[1]), []).append(int(each.parent.name))
    found = [process]
    for each in found:
        found.extend(parents.get(each, []))
    return found


def stop_node(process):
    """End a node and the processes that it has started, and no others."""
    started = descendants(process.pid)
    process.terminate()
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.wait(30)
    for each in started:
        with contextlib.suppress(ProcessLookupError):
            os.kill(each, signal.SIGKILL)
    process.wait()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return a folder of scenes, two of which cannot be ranked."""
    made = make_folder(tmp_path_factory.mktemp("ray") / "scenes", 30)
    write_scene(made, "broken", "{")
    gone = {"car": {"mesh": "gone.obj", "kind": "car"}}
    write_scene(made, "no-model", scene(0, models=gone, actors=[]))
    return made


@pytest.fixture(scope="module")
def reference(folder, tmp_path_factory):
    return run_batch(folder, "-o", tmp_path_factory.mktemp("reference") / "out", "--sequential")


def test_a_ray_of_its_own_has_the_same_results(folder, reference, tmp_path):
    before = set(ray_processes())
    out = tmp_path / "out"
    done = run_batch(folder, "-o", out, "--engine", "ray", "--workers", 2, **QUIET)
    assert done["results"] == reference["results"]
    assert (done["errors"], done["complete"]) == (2, True)
    assert len(done["messages"].splitlines()) == 1
    end = time.monotonic() + 30
    while set(ray_processes()) - before:
        assert time.monotonic() < end, "processes of Ray are left"
        time.sleep(0.1)
    assert run_batch(folder, "-o", out, "--sequential")["found_rows"] == 32


def ray_processes():
    found = []
    for each in pathlib.Path("/proc").glob("[0-9]*/cmdline"):
        line = command_line(each.parent.name)
        if b"raylet" in line or b"gcs_server" in line or line.startswith(b"ray::"):
            found.append(int(each.parent.name))
    return found


def test_a_cluster_of_two_nodes_has_the_same_results(cluster, folder, reference, tmp_path):
    words = (folder, *cluster.options, "--reports", 2)
    done = run_batch(*words, "-o", tmp_path / "a", "--rows-per-part", 1, **QUIET)
    assert done["results"] == reference["results"]
    assert len(list((tmp_path / "a/_reports").glob("*.html"))) == 2
    again = run_batch(*words, "-o", tmp_path / "b", "--rows-per-part", 5, **QUIET)
    assert again["results"] == reference["results"]
    assert count_nodes(cluster.address) == 2, "the cluster is not the program's to end"


def test_actors_that_are_killed_are_replaced(cluster, folder, reference, tmp_path):
    out = tmp_path / "out"
    words = (folder, "-o", out, *cluster.options, "--rows-per-part", 2)
    with running(*words, **QUIET) as run:
        wait_for_parts(out, 1)
        actors = cluster.actors()
        assert actors
        for actor in actors:  # those of a run before that are still ending, too
            os.kill(actor, signal.SIGKILL)
        printed, messages = run.communicate(timeout=240)
        assert run.returncode == 0, messages
    assert "a worker ended in part" in messages
    assert reference["results"] in printed


@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGKILL])
def test_a_run_that_ends_early_is_resumed(cluster, folder, reference, tmp_path, sign):
    out = tmp_path / "out"
    words = (folder, "-o", out, *cluster.options, "--rows-per-part", 2)
    with running(*words, **QUIET) as run:
        wait_for_parts(out, 2)
        run.send_signal(sign)
        assert run.wait(60) == (4 if sign == signal.SIGINT else -sign)
    there = len(list(out.glob("part-*.parquet")))
    assert there < 16
    done = run_batch(*words, **QUIET)
    assert done["found_rows"] >= 2 * (there - 1)
    assert done["results"] == reference["results"]


def test_an_address_without_a_cluster_is_one_line(folder, tmp_path):
    words = (folder, "-o", tmp_path / "out", "--engine", "ray", "--address", "127.0.0.1:1")
    done = run_batch(*words, code=3, **QUIET)
    assert "--address" in done["messages"]
    assert "Traceback" not in done["messages"]
