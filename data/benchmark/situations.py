"""Draws scenes in which a crash can hardly be avoided: fourteen situations, each from a number.

`draw(situation, number)` returns the same scenario on every machine.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from scene import MODELS, WORDS, Scene, a, edge_words, short


def junction(number: int) -> dict[str, Any]:
    """Return a junction in town that something large crosses."""
    s = Scene("junction", number, (11, 18))
    x, side = s.ahead(0.45, 0.85), s.pick(-1, 1)
    after = 1.1 * x / s.speed
    large = s.pick("truck", "semitrailer", "tram", "van")
    s.crossing(large, x + 1.5, s.real(-2, 2), after, side, s.real(1.5, 6))
    other = s.pick("sedan", "motorcycle", "hatch", "bicycle", "van")
    half = (MODELS[other][3] - MODELS[other][2]) / 2
    s.put(other, x - 1.5 - half - s.real(0, 3), 3.3, 180, s.real(1, 4), -1)
    waits = s.pick("pedestrian", "bicycle", "motorcycle", "hatch")
    s.put(waits, x - s.real(3, 4), -3.6, s.real(60, 90))
    s.put("pole", x - 1.0, -s.real(2.6, 3.4))
    s.edge(-1, s.real(4.4, 5.4), "wall", x - 1.5)
    s.edge(1, s.real(5.0, 5.6), s.pick("parked", "wall", "people"), x - 1.5)
    came = "left" if side > 0 else "right"
    return s.done(f"A junction in town: {a(large)} from the {came} runs the red light, "
                  f"{a(other)} comes towards us, {a(waits)} waits at the corner.")


def oncoming(number: int) -> dict[str, Any]:
    """Return a country road on which an overtaker comes towards the ego."""
    s = Scene("oncoming", number, (18, 26), road_grip(number), 2.8)
    speed = s.real(15, 25, 1)
    x = s.front + s.real(0.7, 1.3) * (s.speed + speed)
    overtaker = s.pick("hatch", "sedan", "van", "motorcycle", "truck")
    s.put(overtaker, x + 4, s.real(-0.7, 0.7), 180, speed, -s.real(2, 6))
    beside = s.pick("truck", "semitrailer", "van", "sedan")
    s.put(beside, x + s.real(-2, 8), 3.6, 180, speed - s.real(2, 5), -2)
    s.queue(x + 18, 3.6, 1, ("sedan", "hatch", "truck"), -speed)
    s.actors[-1]["pose"].update(yaw_deg=180)
    s.actors[-1].update(speed_mps=speed)
    right = s.pick("trees", "wall", "barrier", "poles")
    s.edge(-1, s.real(2.1, 3.4), right, 38)
    s.edge(1, s.real(5.6, 6.6), s.pick("poles", "wall"), 45)
    return s.done(f"A country road: {a(overtaker)} that overtakes {a(beside)} comes "
                  f"towards us in our lane; {edge_words(right)} on the right.")


def tail_back(number: int) -> dict[str, Any]:
    """Return the end of a queue on a motorway."""
    s = Scene("tail-back", number, (25, 36), horizon_s=3.2)
    x = s.ahead(0.35, 0.75)
    lanes = s.pick((0, 3.6), (0, -3.6), (0, 3.6, -3.6))
    first = []
    for lane in lanes:
        s.queue(x + s.real(-5, 8), lane, 2, ("sedan", "hatch", "truck", "van", "motorcycle",
                                             "semitrailer"), s.pick(0, 0, 2))
        first.append(s.actors[-2]["model"])
    s.put(s.pick("sedan", "truck", "van"), -s.real(9, 15), s.real(-0.3, 0.3), 0, s.speed, -5)
    beside = s.pick("motorcycle", "sedan", "hatch")
    s.put(beside, s.real(4, 10), lanes[1], 0, s.speed - s.real(2, 6), -6)
    s.left = s.right = 3.5
    s.edge(1, max(lanes) + s.real(2.4, 3.4), "wall", x + 6)
    s.edge(-1, -min(lanes) + s.real(2.2, 4.0), s.pick("wall", "poles"), x + 6)
    return s.done(f"A motorway behind a bend, {len(lanes)} lanes: traffic stands or crawls, last "
                  f"{a(first[0])} in our lane; {a(beside)} brakes beside us, another follows.")


def child(number: int) -> dict[str, Any]:
    """Return a child that runs out between parked cars."""
    s = Scene("child", number, (9.5, 14))
    x, speed = s.ahead(0.3, 0.75), s.real(1.6, 3.2)
    after = 1.05 * (x - s.front) / s.speed
    runner = s.pick("child", "child", "child", "pedestrian")
    s.crossing(runner, x, s.real(-0.5, 0.4), after, -1, speed)
    s.edge(-1, s.real(1.55, 1.9), "parked", x - 1, -2)
    s.edge(-1, s.real(1.55, 1.9), "parked", x + s.real(7.2, 8), x + 5)
    other = s.pick("hatch", "van", "motorcycle", "truck", "bicycle")
    s.put(other, x + s.real(-1, 5) + 5 * after, s.real(2.6, 3.1), 180, 5, -s.pick(0, 3))
    s.edge(1, s.real(4.3, 4.9), s.pick("wall", "people", "parked"), x + 8)
    if s.chance(0.4):
        s.put(s.pick("pedestrian", "child"), x + 1.5, -s.real(2.6, 3), 90, 0.8)
    s.left, s.right = s.real(1.2, 2.6, 1), s.real(0.5, 1.0, 1)
    return s.done(f"A street between parked cars: {a(runner)} runs out from the right, "
                  f"{a(other)} comes towards us.")


def cyclist(number: int) -> dict[str, Any]:
    """Return a cyclist behind a crest."""
    s = Scene("cyclist", number, (16, 22), horizon_s=2.8)
    x = s.ahead(0.15, 0.4)
    s.put("bicycle", x, s.real(-0.6, 0.5), s.real(-3, 3), s.real(3, 5))
    if s.chance(0.4):
        s.put("bicycle", x + s.real(2.5, 4), s.real(-0.6, 0.5), 0, 4)
    other = s.pick("sedan", "hatch", "truck", "motorcycle", "van")
    s.put(other, x + s.real(10, 18), s.real(2.8, 3.4), 180, s.real(12, 18), -4)
    right = s.pick("trees", "wall", "poles")
    s.edge(-1, s.real(1.7, 2.4), right, 38)
    s.edge(1, s.real(4.9, 5.4), s.pick("wall", "poles"), 38)
    s.queue(x + s.real(8, 12), s.real(-0.3, 0.3), 1, ("truck", "van", "sedan"), 2)
    s.left, s.right = s.real(1.5, 3.5, 1), s.real(0.6, 1.2, 1)
    return s.done(f"A country road: behind a crest rides a cyclist in our lane, {a(other)} "
                  f"comes towards us; {edge_words(right)} on the right.")


def motorcyclist(number: int) -> dict[str, Any]:
    """Return a motorcyclist beside the ego while the traffic ahead stops."""
    s = Scene("motorcyclist", number, (18, 27))
    x, side = s.ahead(0.3, 0.65), s.pick(-1, 1)
    ahead = s.pick("sedan", "truck", "van", "hatch")
    s.queue(x, 0, 2, (ahead, "truck", "van"), s.pick(0, 0, 3), 0)
    s.put("motorcycle", s.real(4, 9), side * s.real(3.0, 3.5), 0, s.speed - s.real(1, 5), -5)
    s.queue(x + s.real(2, 10), 3.5 * side, 1, ("hatch", "sedan", "van", "truck"))
    s.edge(side, 3.5 + s.real(1.8, 2.6), s.pick("wall", "barrier", "trees"), x + 10)
    s.edge(-side, s.real(1.8, 3.2), s.pick("wall", "barrier", "poles"), x + 10)
    s.put(s.pick("sedan", "truck"), -s.real(9, 14), 0, 0, s.speed, -6)
    s.left = s.right = s.real(1.5, 3.0, 1)
    where = "left" if side > 0 else "right"
    return s.done(f"Two lanes: the traffic ahead stops at once, a motorcyclist rides beside us on "
                  f"the {where}, one follows closely.")


def lorry(number: int) -> dict[str, Any]:
    """Return the rear of a lorry that brakes on a wet road."""
    s = Scene("lorry", number, (19, 26), 0.55)
    x, rear = s.ahead(0.2, 0.5), s.pick("truck", "semitrailer", "truck", "van")
    s.queue(x, s.real(-0.4, 0.4), 1, (rear,), s.real(0, 6), -3)
    other = s.pick("hatch", "sedan", "motorcycle", "truck")
    s.put(other, x + s.real(10, 26), 3.5, 180, s.real(12, 18), -4)
    s.put(s.pick("sedan", "hatch", "van"), x + s.real(38, 46), 3.5, 180, 14, -4)
    right = s.pick("barrier", "trees", "wall", "poles")
    s.edge(-1, s.real(1.9, 3.0), right, x + 12)
    s.edge(1, s.real(5.1, 6.0), s.pick("wall", "barrier"), x + 12)
    s.left, s.right = s.real(1.5, 3.5, 1), s.real(0.8, 1.6, 1)
    return s.done(f"A wet country road: the {WORDS[rear]} ahead brakes in full, {a(other)} "
                  f"comes towards us; {edge_words(right)} on the right.")


def roadside(number: int) -> dict[str, Any]:
    """Return a wreck across the lane between poles and barriers."""
    s = Scene("roadside", number, (16, 24), road_grip(number))
    x = s.ahead(0.35, 0.8)
    wreck = s.pick("sedan", "hatch", "van", "truck")
    s.put(wreck, x + 2.5, s.real(-0.5, 1.5), s.pick(60, 90, 120, -90, -60), occupants=s.pick(1, 2))
    if s.chance(0.6):
        s.put("pedestrian", x - s.real(0, 2), s.real(-2.2, 3.5), s.real(0, 350))
    other = s.pick("hatch", "sedan", "truck", "motorcycle")
    s.put(other, x + s.real(1, 6), 4.0, s.real(160, 200))
    right, left = s.pick("poles", "barrier", "trees"), s.pick("barrier", "trees", "poles", "wall")
    s.edge(-1, s.real(1.9, 2.8), right, x + 5)
    s.edge(1, s.real(5.2, 6.2), left, x + 5)
    s.left = s.right = s.real(1.0, 2.6, 1)
    return s.done(f"{a(wreck).capitalize()} lies across the lane, {a(other)} has stopped "
                  f"beside it; {edge_words(right)} on the right, {edge_words(left)} on the left.")


def stop(number: int) -> dict[str, Any]:
    """Return a stop of a tram from which people cross."""
    s = Scene("stop", number, (9, 14))
    x, side = s.ahead(0.35, 0.75), s.pick(-1, 1)
    after = 1.05 * (x - s.front) / s.speed
    s.put("tram", x + s.real(-3, 12), 2.9 * side, 0 if side < 0 else 180)
    runner = s.pick("pedestrian", "child", "wheelchair", "pedestrian")
    s.crossing(runner, x, s.real(-0.4, 0.4), after, s.pick(side, -side), s.real(0.6, 1.6))
    s.crossing(s.pick("pedestrian", "child"), x + s.real(0.8, 2.2), -s.real(0.8, 1.2) * side,
               after, -side, s.real(0.4, 1.2))
    edge = s.pick("parked", "people", "wall")
    s.edge(-side, s.real(1.9, 2.6), edge, x + 8)
    s.queue(x + s.real(5, 9), 0, 1, ("hatch", "van", "bicycle", "truck"))
    s.left = s.right = s.real(0.6, 1.4, 1)
    where = "left" if side > 0 else "right"
    return s.done(f"A tram stands at its stop on the {where}: {a(runner)} and another cross "
                  f"in front of us; {edge_words(edge)} on the other side.")


def cut_in(number: int) -> dict[str, Any]:
    """Return a vehicle that cuts in and brakes."""
    s = Scene("cut-in", number, (24, 34))
    x, side = s.front + s.real(2, 9), s.pick(-1, 1)
    cutter = s.pick("sedan", "hatch", "van", "motorcycle", "truck")
    length = (MODELS[cutter][3] - MODELS[cutter][2]) / 2
    s.put(cutter, x + length, 1.9 * side, -s.real(2, 5) * side, s.speed - s.real(5, 10), -7)
    s.queue(s.ahead(0.5, 0.8), 0, 2, ("truck", "semitrailer", "sedan", "van"), s.pick(0, 3))
    s.queue(s.ahead(0.5, 0.8), 3.6 * side, 1, ("truck", "sedan", "motorcycle"), s.pick(0, 3))
    follower = s.pick("truck", "sedan", "van", "motorcycle")
    s.put(follower, -s.real(10, 16), 0, 0, s.speed, -5)
    beside = s.pick("hatch", "sedan", "motorcycle", "truck")
    s.put(beside, -s.real(7, 12), 3.6 * side, 0, s.speed, -3)
    s.edge(-side, s.real(1.9, 3.4), s.pick("poles", "wall"), s.stop - 5)
    s.edge(side, 3.6 + s.real(1.9, 2.8), "wall", s.stop - 5)
    s.left = s.right = s.real(1.2, 3.0, 1)
    where = "left" if side > 0 else "right"
    return s.done(f"A motorway: {a(cutter)} cuts in from the {where} and brakes before a "
                  f"queue, {a(follower)} follows and {a(beside)} is beside us.")


def squeeze(number: int) -> dict[str, Any]:
    """Return a gap between two vehicles that closes."""
    s = Scene("squeeze", number, (10, 17))
    x = s.ahead(0.35, 0.8)
    after = 1.1 * x / s.speed
    stands = s.pick("truck", "van", "sedan", "semitrailer")
    half = (MODELS[stands][3] - MODELS[stands][2]) / 2
    s.put(stands, x + half, -s.real(0.9, 1.6), s.real(-2, 4), occupants=s.pick(0, 1))
    comes = s.pick("truck", "tram", "van", "sedan")
    speed = s.real(4, 9)
    reach = (MODELS[comes][3] - MODELS[comes][2]) / 2
    s.put(comes, x + reach + speed * after - s.real(0, 4), s.real(2.2, 3.0), 180, speed)
    rider = s.pick("motorcycle", "bicycle")
    s.put(rider, x - s.real(2, 6), s.real(-1.6, -1.2), 0, s.real(2, 5))
    s.edge(-1, s.real(2.6, 3.2), s.pick("parked", "wall", "people"), x + 2)
    s.edge(1, s.real(4.3, 4.9), s.pick("wall", "people", "poles"), x + 6)
    s.left, s.right = s.real(0.8, 2.4, 1), s.real(0.5, 1.2, 1)
    return s.done(f"A narrow street: {a(stands)} stands in our lane, {a(comes)} comes "
                  f"through the gap beside it, {a(rider)} rides ahead of us.")


def chain(number: int) -> dict[str, Any]:
    """Return vehicles that can be pushed into people and into each other."""
    s = Scene("chain", number, (13, 20))
    x = s.ahead(0.35, 0.7)
    last = s.pick("hatch", "sedan", "van", "motorcycle")
    half = (MODELS[last][3] - MODELS[last][2]) / 2
    s.put(last, x + half, s.real(-0.4, 0.4))
    beyond = x + 2 * half
    for y in (-0.6, 0.8):
        s.put(s.pick("pedestrian", "child", "wheelchair", "bicycle"), beyond + s.real(1.2, 2.5),
              y, s.pick(90, -90), s.real(0.3, 1.3))
    s.queue(beyond + s.real(5, 7), 0, 2, ("hatch", "sedan", "truck"))
    beside = s.pick("sedan", "truck", "van", "motorcycle")
    s.queue(x + s.real(-3, 6), 3.4, 2, (beside, "hatch", "van"))
    right = s.pick("parked", "wall", "people", "poles")
    s.edge(-1, s.real(1.9, 2.6), right, beyond + 2)
    s.edge(1, s.real(5.2, 5.8), s.pick("wall", "poles"), beyond + 2)
    s.put(s.pick("sedan", "truck", "motorcycle"), -s.real(8, 12), 0, 0, s.speed, -6)
    s.left, s.right = s.real(1.2, 3.4, 1), s.real(0.6, 1.4, 1)
    return s.done(f"{a(last).capitalize()} has stopped before people on a crossing, traffic "
                  "stands beside and behind it, one follows us; "
                  f"{edge_words(right)} on the right.")


def split(number: int) -> dict[str, Any]:
    """Return a junction at which others may do several things."""
    s = Scene("split", number, (11, 17))
    s.version = 2
    x = s.ahead(0.45, 0.8)
    other = s.pick("motorcycle", "hatch", "bicycle", "sedan", "truck")
    speed = s.real(2, 5)
    turning = s.put(other, x - s.real(1, 3), 3.3, 180)
    p = s.real(0.2, 0.6, 1)
    pose = turning.pop("pose")
    turning.update(pose=pose, speed_mps=speed, predictions=[
        {"probability": p}, {"probability": round(1 - p, 1), "yaw_rate_dps": s.real(25, 50, 0),
                             "acceleration_mps2": -1}])
    walker = s.pick("pedestrian", "child", "wheelchair")
    crossing = s.put(walker, x - s.real(0, 3), -s.real(1.6, 2.6), 90)
    q = s.real(0.2, 0.7, 1)
    crossing.update(predictions=[{"probability": q, "speed_mps": s.real(1, 2.2)},
                                 {"probability": round(1 - q, 1)}])
    stands = s.pick("truck", "van", "tram", "semitrailer")
    s.crossing(stands, x + s.real(3.2, 4), s.real(-1, 3), 0, s.pick(-1, 1), 0)
    right = s.pick("wall", "parked")
    s.edge(-1, s.real(2.9, 3.6), right, x + 1.4)
    s.edge(1, s.real(4.9, 5.6), s.pick("wall", "people"), x + 1.4)
    s.left, s.right = s.real(1.0, 2.8, 1), s.real(0.6, 1.5, 1)
    return s.done(f"{a(stands).capitalize()} blocks a junction; {a(other)} comes towards us and "
                  f"may turn, {a(walker)} at the kerb may step out.")


def off_road(number: int) -> dict[str, Any]:
    """Return a way out over the grass that ends at something else."""
    s = Scene("off-road", number, (18, 26))
    s.version = 2
    x = s.ahead(0.35, 0.7)
    ahead = s.pick("sedan", "truck", "hatch", "van", "tree")
    turned = s.pick(0, 15, 60, 90, -70)
    s.put(ahead, x + 2.5, s.real(-0.6, 0.6), turned)
    other = s.pick("hatch", "sedan", "truck", "motorcycle")
    s.put(other, x + s.real(8, 22), 3.5, 180, s.real(10, 16), -5)
    ends = s.pick("trees", "wall", "poles", "people")
    s.edge(-1, s.real(3.6, 5.0), ends, x + 14)
    s.edge(1, s.real(6.0, 7), s.pick("poles", "wall"), x + 14)
    s.queue(x + s.real(8, 10), s.real(-0.5, 0.5), 1, ("truck", "van"))
    grip, harm = s.real(0.5, 0.65), s.pick(0, 0.01, 0.02)
    s.beside = 0.95 * grip / s.grip
    s.extra = {"road": {"drivable": [{"outer": [[-40, -1.9], [200, -1.9], [200, 5.4], [-40, 5.4]]}],
                        "off_road": short({"harm_per_leaving": harm, "grip": grip})}}
    s.left, s.right = s.real(1.5, 3.5, 1), s.real(1.5, 3.5, 1)
    what = "A tree" if ahead == "tree" else a(ahead).capitalize()
    return s.done(f"{what} blocks our lane, {a(other)} comes towards us; grass on the "
                  f"right, {edge_words(ends)} beyond it.")


def road_grip(number: int) -> float:
    """Return the grip of a dry, damp or wet road, by the number."""
    return (0.8, 0.8, 0.65, 0.5)[number % 4]


SITUATIONS: dict[str, Callable[[int], dict[str, Any]]] = {
    "junction": junction, "oncoming": oncoming, "tail-back": tail_back, "child": child,
    "cyclist": cyclist, "motorcyclist": motorcyclist, "lorry": lorry, "roadside": roadside,
    "stop": stop, "cut-in": cut_in, "squeeze": squeeze, "chain": chain, "split": split,
    "off-road": off_road,
}


def draw(situation: str, number: int) -> dict[str, Any]:
    """Return the scenario of a situation and number."""
    return SITUATIONS[situation](number)
