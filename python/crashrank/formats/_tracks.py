"""Tracks as motions: cut to the horizon, continued where they end, cleaned where they jump.

crashrank reads poses from time 0 on and lets a body stand still after its last one. Recordings
begin late, end early and jump. What is done about it is in the report.
"""

from __future__ import annotations

import bisect
import math
from dataclasses import dataclass
from itertools import pairwise

from ._scene import Body, Pose, Report, State, Track, moved, wrapped

MAX_SPEED_MPS = 150.0
# What a person reaches on foot, and on a bicycle: faster ones are measured so, and kept.
LEAP_MPS = {"pedestrian": 8.0, "bicycle": 25.0}
MAX_TURN_RADPS = math.radians(700.0)
LEAST_STEP_S = 0.005
STANDING_MPS = 0.05
SIDEWAYS_RAD = math.radians(5.0)
_SAME_TIME_S = 1e-6
_MAX_POSES = 5_000


@dataclass
class Motion:
    """How a body moves from time 0 on: constant speed and yaw rate, or timed poses.

    `poses` has seconds from time 0 and the middle of the box. It is empty where `speed_mps` and
    `yaw_rate_radps` say all. Outside of `recorded_s`, from when to when, s from time 0, it is this
    module's continuation.
    """

    start: Pose
    speed_mps: float
    yaw_rate_radps: float
    poses: list[tuple[float, Pose]]
    probability: float = 1.0
    recorded_s: tuple[float, float] = (-math.inf, math.inf)


def motions(body: Body, time_s: float, horizon_s: float, report: Report) -> list[Motion]:
    """Return the motions of a body, one for each of its tracks; none if it is not there.

    Parameters
    ----------
    time_s, horizon_s : float
        Moment of decision on the file's clock, and seconds after it that count.
    """
    if body.stands:
        return [Motion(body.tracks[0].states[0].pose, 0.0, 0.0, [])]
    found = []
    for track in body.tracks:
        motion = _motion(track, body, time_s, horizon_s, report)
        if motion is not None:
            found.append(motion)
    total = sum(each.probability for each in found)
    for each in found:
        each.probability /= total
    return found


def state_at(track: Track, time_s: float) -> State:
    """Return the state at a time within the track, between two states in proportion."""
    states = track.states
    i = bisect.bisect_left(states, time_s - _SAME_TIME_S, key=lambda state: state.t_s)
    i = min(i, len(states) - 1)
    after = states[i]
    if i == 0 or abs(after.t_s - time_s) <= _SAME_TIME_S:
        return _with_velocity(states, i)
    before = states[i - 1]
    share = (time_s - before.t_s) / (after.t_s - before.t_s)
    share = min(max(share, 0.0), 1.0)
    a, b = _with_velocity(states, i - 1), _with_velocity(states, i)
    (ax, ay), (bx, by) = a.velocity_mps or (0.0, 0.0), b.velocity_mps or (0.0, 0.0)
    velocity = ax + share * (bx - ax), ay + share * (by - ay)
    rate = None
    if a.yaw_rate_radps is not None and b.yaw_rate_radps is not None:
        rate = a.yaw_rate_radps + share * (b.yaw_rate_radps - a.yaw_rate_radps)
    return State(time_s, _between(a.pose, b.pose, share), velocity, rate)


def _between(a: Pose, b: Pose, share: float) -> Pose:
    turn = wrapped(b.yaw_rad - a.yaw_rad)
    return Pose(
        a.x_m + share * (b.x_m - a.x_m),
        a.y_m + share * (b.y_m - a.y_m),
        wrapped(a.yaw_rad + share * turn),
    )


def _with_velocity(states: list[State], i: int) -> State:
    """Return a state with a velocity and, where neighbours tell it, a yaw rate."""
    state = states[i]
    if state.velocity_mps is not None and state.yaw_rate_radps is not None:
        return state
    low, high = max(i - 1, 0), min(i + 1, len(states) - 1)
    seconds = states[high].t_s - states[low].t_s
    a, b = states[low].pose, states[high].pose
    velocity, rate = state.velocity_mps, state.yaw_rate_radps
    if velocity is None:
        velocity = (0.0, 0.0)
        if seconds > 0.0:
            velocity = ((b.x_m - a.x_m) / seconds, (b.y_m - a.y_m) / seconds)
    if rate is None and seconds > 0.0:
        rate = wrapped(b.yaw_rad - a.yaw_rad) / seconds
    return State(state.t_s, state.pose, velocity, rate)


def forward_speed(state: State) -> float:
    """Return the speed along the heading, m/s; negative in reverse."""
    x, y = state.velocity_mps or (0.0, 0.0)
    return x * math.cos(state.pose.yaw_rad) + y * math.sin(state.pose.yaw_rad)


def sideways_speed(state: State) -> float:
    """Return the speed to the left of the heading, m/s."""
    x, y = state.velocity_mps or (0.0, 0.0)
    return y * math.cos(state.pose.yaw_rad) - x * math.sin(state.pose.yaw_rad)


def _motion(
    track: Track, body: Body, time_s: float, horizon_s: float, report: Report
) -> Motion | None:
    name, states = body.name, track.states
    first, last = states[0], states[-1]
    end_s = time_s + horizon_s
    if len(states) == 1:
        state = _shifted(_with_velocity(states, 0), time_s, name, report)
        motion = _constant(state, track, horizon_s)
        if motion.speed_mps or motion.poses:
            motion.recorded_s = (first.t_s - time_s, first.t_s - time_s)
        return motion
    if first.t_s > end_s:
        report.leave_out(f"{name} appears at {first.t_s:g} s, after the horizon")
        return None
    if last.t_s < time_s - _SAME_TIME_S:
        report.leave_out(f"{name} ends at {last.t_s:g} s, before the moment of decision")
        return None
    cleaned = Track(_cleaned(states, name, time_s, end_s, report), track.probability)
    states = cleaned.states
    _report_leaps(states, body, report)
    first, last = states[0], states[-1]
    if first.t_s > time_s + _SAME_TIME_S:
        report.warn(
            f"{name} appears {first.t_s - time_s:.3g} s after the moment of decision: moved back "
            "along its first velocity"
        )
        start = _continued(_with_velocity(states, 0), time_s)
    elif last.t_s < time_s - _SAME_TIME_S:
        start = _continued(_with_velocity(states, len(states) - 1), time_s)
    else:
        start = state_at(cleaned, time_s)
    poses = [(0.0, start.pose)]
    for state in states:
        t_s = state.t_s - time_s
        if t_s > poses[-1][0] + LEAST_STEP_S and t_s <= horizon_s:
            poses.append((t_s, state.pose))
    beyond = horizon_s > poses[-1][0] + LEAST_STEP_S
    if last.t_s >= end_s - _SAME_TIME_S:
        if beyond:
            poses.append((horizon_s, state_at(cleaned, end_s).pose))
    else:
        final = _with_velocity(states, len(states) - 1)
        if math.hypot(*(final.velocity_mps or (0.0, 0.0))) > STANDING_MPS:
            report.assume("goes on with its last velocity until the horizon", name)
            if beyond:
                poses.append((horizon_s, _continued(final, end_s).pose))
    poses = _thinned(_turning_slowly(poses, name, report))
    return Motion(
        start.pose,
        forward_speed(start),
        start.yaw_rate_radps or 0.0,
        poses if len(poses) > 1 else [],
        track.probability,
        (first.t_s - time_s, last.t_s - time_s),
    )


def _shifted(state: State, time_s: float, name: str, report: Report) -> State:
    """Return the only state of a track, moved to the moment of decision."""
    if abs(state.t_s - time_s) <= _SAME_TIME_S:
        return state
    if math.hypot(*(state.velocity_mps or (0.0, 0.0))) > STANDING_MPS:
        report.assume(f"its only state, at {state.t_s:g} s, is moved on with its velocity", name)
    return _continued(state, time_s)


def _continued(state: State, time_s: float) -> State:
    """Return the state that constant velocity leads to, without turning."""
    x, y = state.velocity_mps or (0.0, 0.0)
    seconds = time_s - state.t_s
    pose = Pose(state.pose.x_m + x * seconds, state.pose.y_m + y * seconds, state.pose.yaw_rad)
    return State(time_s, pose, state.velocity_mps, 0.0)


def _constant(state: State, track: Track, horizon_s: float) -> Motion:
    """Return a motion of constant velocity: along the heading as a speed, else as two poses."""
    ahead, left = forward_speed(state), sideways_speed(state)
    speed = math.hypot(ahead, left)
    if speed <= STANDING_MPS:
        return Motion(state.pose, 0.0, 0.0, [], track.probability)
    if abs(left) <= abs(ahead) * math.tan(SIDEWAYS_RAD):
        # A body turns about its origin, not about the middle of its box: small beside what a
        # constant yaw rate leaves open.
        rate = state.yaw_rate_radps or 0.0
        rate = min(max(rate, -MAX_TURN_RADPS), MAX_TURN_RADPS)
        return Motion(state.pose, ahead, rate, [], track.probability)
    end = moved(state.pose, ahead * horizon_s, left * horizon_s)
    return Motion(state.pose, ahead, 0.0, [(0.0, state.pose), (horizon_s, end)], track.probability)


def _cleaned(
    states: list[State], name: str, time_s: float, end_s: float, report: Report
) -> list[State]:
    """Return the states around the horizon that hang together: a body that jumps is cut there."""
    low = bisect.bisect_left(states, time_s, key=lambda state: state.t_s)
    high = bisect.bisect_right(states, end_s, key=lambda state: state.t_s)
    low = max(low - 2, 0)
    near = states[low : max(high + 1, low + 1)]
    kept = near[:1]
    for state in near[1:]:
        before = kept[-1]
        way = math.hypot(state.pose.x_m - before.pose.x_m, state.pose.y_m - before.pose.y_m)
        if way <= MAX_SPEED_MPS * max(state.t_s - before.t_s, LEAST_STEP_S):
            kept.append(state)
        elif state.t_s <= time_s:
            kept = [state]
            report.warn(f"{name} jumps {way:.3g} m to its place at {state.t_s:g} s")
        else:
            report.warn(f"{name} jumps {way:.3g} m at {state.t_s:g} s: cut there, and continued")
            break
    return kept


def _report_leaps(states: list[State], body: Body, report: Report) -> None:
    """Warn of a person who moves faster than one can."""
    most = LEAP_MPS.get(body.kind, math.inf)
    leaps = [
        f"{b.t_s:g}"
        for a, b in pairwise(states)
        if math.dist(a.pose[:2], b.pose[:2]) > most * max(b.t_s - a.t_s, LEAST_STEP_S)
    ]
    if leaps:
        at = ", ".join(leaps[:5]) + (f" and {len(leaps) - 5} more times" if leaps[5:] else "")
        report.warn(f"{body.name} jumps at {at} s, faster than {most:g} m/s: kept as recorded")


def _turning_slowly(
    poses: list[tuple[float, Pose]], name: str, report: Report
) -> list[tuple[float, Pose]]:
    """Return the poses with headings that turn no faster than a body can."""
    kept = poses[:1]
    for t_s, pose in poses[1:]:
        before = kept[-1]
        turn = wrapped(pose.yaw_rad - before[1].yaw_rad)
        most = MAX_TURN_RADPS * (t_s - before[0])
        if abs(turn) > most:
            report.warn(
                f"{name} turns {math.degrees(turn):.3g} degrees within {t_s - before[0]:.3g} s: "
                "its heading follows more slowly"
            )
            yaw = wrapped(before[1].yaw_rad + math.copysign(most, turn))
            pose = Pose(pose.x_m, pose.y_m, yaw)
        kept.append((t_s, pose))
    return kept


def _thinned(poses: list[tuple[float, Pose]]) -> list[tuple[float, Pose]]:
    """Return few enough poses, the last one kept; a body that does not move has one."""
    if len(poses) > _MAX_POSES:
        step = math.ceil(len(poses) / _MAX_POSES)
        poses = poses[:-1:step] + poses[-1:]
    first = poses[0][1]
    if all(
        math.hypot(pose.x_m - first.x_m, pose.y_m - first.y_m) < 1e-6
        and abs(wrapped(pose.yaw_rad - first.yaw_rad)) < 1e-6
        for _, pose in poses
    ):
        return poses[:1]
    return poses


def checked_track(states: list[State]) -> list[State]:
    """Return states by rising time; of several at one time the last."""
    by_time: dict[float, State] = {}
    for state in states:
        by_time[round(state.t_s, 9)] = state
    return [by_time[t_s] for t_s in sorted(by_time)]
