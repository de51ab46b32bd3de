"""Rates of crashrank-batch by engine, in turn, in one run.

Each engine ranks the same scenes of about 10 ms, few and many of them, round after round. The
difference of the two sizes is the cost of a scene, the rest the start. Processor time is that of
the program and of every process that it starts, sampled; other work on the machine makes it little
longer, which cannot be said of wall times. Where each process had a processor to itself, the
busiest process would set the pace. Run it with the package on PYTHONPATH.

usage: batch_rates.py [--scenes 60] [--rounds 3] [--engines sequential,local-2,ray-2]
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python/tests"))

import pyarrow as pa
import pyarrow.parquet as pq
from batch_scenes import make_models, scene

TICKS = os.sysconf("SC_CLK_TCK")
FACTOR = 10  # many scenes over few


def processor_times():
    """Return parent and processor time of every process, s."""
    found = {}
    for entry in pathlib.Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = entry.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        found[int(entry.parent.name)] = int(fields[1]), (int(fields[11]) + int(fields[12])) / TICKS
    return found


class Sampler(threading.Thread):
    """Keeps the processor time of a process and of all that it has started."""

    def __init__(self, root):
        super().__init__(daemon=True)
        self.root = root
        self.times = {}
        self.ended = threading.Event()

    def run(self):
        while not self.ended.wait(0.1):
            now = processor_times()
            mine = {self.root} | set(self.times)
            grown = True
            while grown:
                more = {each for each, (parent, _) in now.items() if parent in mine} - mine
                mine |= more
                grown = bool(more)
            for each in mine & set(now):
                self.times[each] = max(self.times.get(each, 0.0), now[each][1])


def options(engine):
    if engine == "sequential":
        return ["--sequential"]
    name, _, workers = engine.partition("-")
    return ["--engine", name, "--workers", workers]


def measure(engine, table, folder):
    """Return wall time, processor time, that of the busiest process, and the results of one run."""
    started = time.monotonic()
    run = subprocess.Popen(
        [sys.executable, "-m", "crashrank.batch", str(table), "-o", str(folder), "--json",
         "--reports", "0", "--rows-per-part", "10", *options(engine)],
        stdout=subprocess.PIPE, text=True,
    )
    sampler = Sampler(run.pid)
    sampler.start()
    printed, _ = run.communicate()
    wall = time.monotonic() - started
    sampler.ended.set()
    sampler.join()
    assert run.returncode == 0
    outcome = json.loads(printed)
    return [wall, sum(sampler.times.values()), max(sampler.times.values())], outcome["results"]


def write_table(folder, count):
    path = folder / f"scenes-{count}.parquet"
    texts = [json.dumps(scene(i)) for i in range(count)]
    pq.write_table(pa.table({"id": [f"{i}" for i in range(count)], "scenario": texts}), path)
    return path


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--engines", default="sequential,local-2,ray-2")
    given = parser.parse_args()
    engines = given.engines.split(",")
    sizes = [given.scenes, FACTOR * given.scenes]
    measured = {engine: [] for engine in engines}
    results = {size: set() for size in sizes}
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        make_models(folder)
        tables = [write_table(folder, size) for size in sizes]
        for turn in range(given.rounds):
            for engine in engines:
                row = []
                for size, table in zip(sizes, tables, strict=True):
                    out = folder / f"{engine}-{size}-{turn}"
                    times, found = measure(engine, table, out)
                    results[size].add(found)
                    row.append(times)
                measured[engine].append(row)
                shown = "  ".join(f"{value:7.2f}" for times in row for value in times)
                load = os.getloadavg()[0]
                print(f"round {turn + 1}  {engine:12}{shown}   load {load:.1f}", flush=True)
    assert all(len(found) == 1 for found in results.values()), "engines differ"
    print(f"\nthe results of all runs are equal; medians of {given.rounds} rounds, {sizes} scenes")
    print("                     ms a scene                             s to start")
    print("engine           wall  processor  busiest process       wall  processor")
    more = sizes[1] - sizes[0]
    costs = {
        engine: [[(many[i] - few[i]) / more for i in range(3)] for few, many in rows]
        for engine, rows in measured.items()
    }
    for engine in engines:
        cost = [statistics.median(each[i] for each in costs[engine]) for i in range(3)]
        start = [
            statistics.median(few[i] for few, _ in measured[engine]) - cost[i] * sizes[0]
            for i in (0, 1)
        ]
        print(
            f"{engine:12} {1e3 * cost[0]:8.2f} {1e3 * cost[1]:10.2f} {1e3 * cost[2]:16.2f}"
            f" {start[0]:10.2f} {start[1]:10.2f}"
        )
    for engine in engines[1:]:
        pairs = list(zip(costs[engines[0]], costs[engine], strict=True))
        rate, processor, pace = (
            statistics.median(value)
            for value in (
                [a[0] / b[0] for a, b in pairs],
                [b[1] / a[1] for a, b in pairs],
                [a[1] / b[2] for a, b in pairs],
            )
        )
        print(
            f"{engine} over {engines[0]}, round by round: {rate:.2f} times the rate, "
            f"{processor:.2f} times the processor time; with a processor for each process "
            f"{pace:.2f} times the rate"
        )


if __name__ == "__main__":
    main()
