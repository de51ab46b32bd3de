"""When a crash can last be avoided, by CriMe and by find_decision_point; scripts/comparison runs it.

    comparison_moments.py FOLDER

Reads the CommonRoad files of ../shared/scenarios, or of the folder that CRASHRANK_SHARED_SCENARIOS
names; where neither is there it says so and ends with 0. Every vehicle whose recording ends in a
contact is an ego. Writes FOLDER/comparison-moments.csv and prints it as a table in Markdown.

Times are those of the last step from which braking, or steering, still avoids every contact: once
by each tool's own dynamics, once with CriMe's jerk limit lifted, its threshold of standstill that
of one step, its way aside that of the lane, and crashrank's grip set to the deceleration that
CriMe then brakes with. Empty: no step of the last three seconds.
"""

from __future__ import annotations

import argparse
import csv
import math
import os
import pathlib
import sys
import time
from collections.abc import Iterator
from typing import Any, NamedTuple

os.environ.setdefault("MPLBACKEND", "Agg")

from commonroad.common.file_reader import CommonRoadFileReader
from commonroad.scenario.obstacle import DynamicObstacle, ObstacleType
from commonroad_crime.data_structure.configuration import CriMeConfiguration
from commonroad_crime.measure.time.ttb import TTB
from commonroad_crime.measure.time.ttc_star import TTCStar
from commonroad_crime.measure.time.tts import TTS
from crashrank import Error, formats
from crashrank.formats._decision import first_contact

ROOT = pathlib.Path(__file__).resolve().parent.parent
FOLDER = pathlib.Path(os.environ.get("CRASHRANK_SHARED_SCENARIOS")
                      or ROOT.parent / "shared/scenarios") / "commonroad"
BEFORE_S = 3.0
AFTER_S = 2.0
SEARCHED_S = 30.0
"""How far after a vehicle's first state its contact may be."""
GRAVITY = 9.80665
VEHICLES = {ObstacleType.CAR, ObstacleType.TRUCK, ObstacleType.BUS, ObstacleType.TAXI,
            ObstacleType.MOTORCYCLE}


class Moments(NamedTuple):
    """Of one ego: times in s on the file's clock, accelerations in m/s2; None: at no step."""

    file: str
    ego: int
    hits: str
    speed_mps: float
    step_s: float
    dynamics: str
    deceleration_mps2: float
    contact_s: float
    crime_contact_s: float | None
    brake_s: float | None
    crime_brake_s: float | None
    steer_s: float | None
    crime_steer_s: float | None
    milliseconds: float
    """Of crashrank, for one step: both ways and the rest of the grid."""
    crime_milliseconds: float
    """Of CriMe, for the times to brake and to steer at one step."""


def contacts(path: pathlib.Path, scenario: Any) -> Iterator[tuple[int, float, str]]:
    """Return id, time of contact and the body hit of every vehicle that goes on into a contact."""
    for body in scenario.dynamic_obstacles:
        if body.obstacle_type not in VEHICLES or not hasattr(body.prediction, "trajectory"):
            continue
        try:
            found = formats.read_commonroad(path, ego=body.obstacle_id, horizon_s=SEARCHED_S)
            contact = first_contact(found)
        except Error as error:
            print(f"{path.name}, ego {body.obstacle_id}: {error}", file=sys.stderr)
            continue
        last = body.prediction.final_time_step * scenario.dt
        if contact and found.report.time_s + 0.5 < contact[0] <= last:
            yield body.obstacle_id, *contact


def crime_moments(scenario: Any, ego: int, step: int, deceleration: float | None
                  ) -> tuple[float | None, float | None, float | None, float]:
    """Return CriMe's times of contact, braking and steering, and its seconds for the last two."""
    config: Any = CriMeConfiguration()
    config.update(ego_id=ego, sce=scenario)
    if deceleration is not None:
        for limit in ("j_x_max", "j_y_max"):
            setattr(config.vehicle.cartesian, limit, 1e6)
            setattr(config.vehicle.cartesian, limit.replace("max", "min"), -1e6)
        # Below this speed CriMe's vehicle stands. At its default, 0.2 m/s, a step of full braking
        # leads past standstill and the vehicle rolls on, forwards and backwards in turn.
        config.time.braking_vel_threshold = deceleration * scenario.dt
        config.time.steer_width = 2  # aside by the width of the lane, not by 0.8 m
    start = step * scenario.dt

    def moment(measure: Any) -> float | None:
        value = float(measure(config).compute(step, verbose=False))
        return round(start + value, 6) if math.isfinite(value) else None

    contact = moment(TTCStar)
    began = time.perf_counter()
    ways = moment(TTB), moment(TTS)
    return contact, *ways, time.perf_counter() - began


def crime_deceleration(heading: float) -> float:
    """Return what CriMe brakes with, m/s2: the engine's limit, clipped along each world axis."""
    defaults: Any = CriMeConfiguration()
    most = defaults.vehicle.params.longitudinal.a_max
    limits = defaults.vehicle.cartesian
    return math.hypot(min(most * abs(math.cos(heading)), limits.a_x_max),
                      min(most * abs(math.sin(heading)), limits.a_y_max))


def curve_of(path: pathlib.Path, ego: int, contact_s: float, first_s: float, step_s: float,
             grip: float | None) -> formats.DecisionCurve:
    """Return the decision curve of an ego at every step of the file, with this grip if stated."""
    moments = []
    for i in range(round((contact_s - first_s) / step_s) + 1):
        at_s = first_s + i * step_s
        if at_s >= contact_s:
            break
        found = formats.read_commonroad(path, ego=ego, time_s=round(at_s, 9),
                                        horizon_s=contact_s - at_s + AFTER_S)
        if grip is not None:
            found.scenario["grip"] = grip
        moments.append(found)
    return formats.find_decision_point(moments, accelerations=15, steerings=15)


def rows_of(path: pathlib.Path) -> Iterator[Moments]:
    """Return the rows of a file, two for each ego."""
    scenario, _ = CommonRoadFileReader(str(path)).open(lanelet_assignment=True)
    for ego, contact_s, hits in contacts(path, scenario):
        body: DynamicObstacle = scenario.obstacle_by_id(ego)
        first = body.initial_state.time_step
        step = max(first, math.ceil((contact_s - BEFORE_S) / scenario.dt))
        state = body.state_at_time(int(contact_s / scenario.dt))
        deceleration = crime_deceleration(state.orientation)
        for agreed in (False, True):
            grip = deceleration / GRAVITY if agreed else None
            began = time.perf_counter()
            curve = curve_of(path, ego, contact_s, step * scenario.dt, scenario.dt, grip)
            spent = time.perf_counter() - began
            try:
                theirs = crime_moments(scenario, ego, step, deceleration if agreed else None)
            except Exception as error:  # of CriMe: any class
                print(f"{path.name}, ego {ego}: CriMe: {error!r}", file=sys.stderr)
                theirs = (None, None, None, math.nan)
            brake, steer = curve.last_avoidable_by_braking, curve.last_avoidable_by_steering
            yield Moments(
                path.stem, ego, hits, round(float(state.velocity), 2), scenario.dt,
                "same deceleration" if agreed else "own", round(deceleration, 2),
                round(contact_s, 3), theirs[0], brake and brake.time_s, theirs[1],
                steer and steer.time_s, theirs[2], round(1000 * spent / len(curve.steps), 1),
                round(1000 * theirs[3], 1))
            print(f"{path.stem}, ego {ego}: done", file=sys.stderr)


def main() -> None:
    """Compare the moments, write the table."""
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("files", nargs="*", type=pathlib.Path, help="default: all")
    options = parser.parse_args()
    if not FOLDER.is_dir():
        print(f"comparison: {FOLDER} is not there: last moments are left out", file=sys.stderr)
        return
    rows: list[Moments] = []
    for path in options.files or sorted(FOLDER.glob("*.xml")):
        try:
            rows += rows_of(path)
        except Exception as error:  # of commonroad-io: any class
            print(f"{path.name}: left out: {error!r}", file=sys.stderr)
    with (options.folder / "comparison-moments.csv").open("w", encoding="utf-8", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(Moments._fields)
        out.writerows(["" if x is None else x for x in row] for row in rows)
    head = ("file, ego", "dynamics", "contact", "brake", "CriMe", "steer", "CriMe")
    print(f"| {' | '.join(head)} |\n{'|---' * len(head)}|")
    for row in rows:
        times = (row.contact_s, row.brake_s, row.crime_brake_s, row.steer_s, row.crime_steer_s)
        cells = ("none" if x is None else f"{x:.2f}" for x in times)
        print(f"| {row.file}, {row.ego} | {row.dynamics} | {' | '.join(cells)} |")


if __name__ == "__main__":
    main()
