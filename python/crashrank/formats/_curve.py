"""Decision curves: the least harm that can still be reached, over time, as text, JSON and plot."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from .._tables import missing

if TYPE_CHECKING:
    from matplotlib.figure import Figure

AT_ONCE = (
    "latest moments, for wheels that turn and brakes that act at once: the real ones are earlier"
)
NOTHING_TO_AVOID = "nothing to avoid, so no last moments"
_COLOURS = {
    "going on": "#c0392b",
    "braking": "#e08e0b",
    "steering": "#7b5ea7",
    "least": "#0b6e99",
}


@dataclass(frozen=True)
class Choice:
    """A manoeuvre that can be chosen at a moment, and what it leads to."""

    candidate: str
    """Its name."""
    acceleration_mps2: float
    """Along the forward axis at the start; negative when braking."""
    curvature_per_m: float
    """Of its path at the start, left positive."""
    score: float | None
    """In the measure's unit; None where a deadline left only the interval."""
    score_interval: tuple[float, float]
    """Bounds on the score; not how uncertain it is."""
    collision_probability: float | None
    """Over all futures; None where a deadline left it open."""
    time_of_impact_s: float | None
    """Earliest first contact of any future, s after the moment of decision."""
    other: str | None
    """Actor that is hit first, in the likeliest future."""
    leaves_road: bool
    """A wheel leaves the drivable areas."""
    least_distance_m: float | None = None
    """To the nearest actor, where no contact is made; None also where a deadline left it open."""
    nearest: str | None = None
    """That actor."""

    @property
    def avoids(self) -> bool:
        """Whether it is known to have no contact in any future."""
        return self.collision_probability == 0.0

    @property
    def most(self) -> float:
        """Score, or the upper bound where it is not known."""
        return self.score_interval[1] if self.score is None else self.score

    @property
    def least(self) -> float:
        """Score, or the lower bound where it is not known."""
        return self.score_interval[0] if self.score is None else self.score


@dataclass(frozen=True)
class DecisionStep:
    """What could be chosen at one moment."""

    time_s: float
    """On the file's clock."""
    going_on: Choice
    """The ego's recorded motion, else its speed and curvature held."""
    best: Choice
    """First of all manoeuvres."""
    braking: Choice | None
    """First of those that brake straight ahead."""
    steering: Choice | None
    """First of those that hold the speed and steer."""
    complete: bool
    """The scores of all of these are known."""

    @property
    def avoidable(self) -> bool:
        """Whether any manoeuvre avoids every contact."""
        return self.best.avoids

    @property
    def avoidable_by_braking(self) -> bool:
        """Whether braking straight ahead avoids every contact."""
        return self.braking is not None and self.braking.avoids

    @property
    def avoidable_by_steering(self) -> bool:
        """Whether steering at held speed avoids every contact."""
        return self.steering is not None and self.steering.avoids

    @property
    def halvable(self) -> bool:
        """Whether a manoeuvre has at most half the score of going on."""
        return self.best.most <= self.going_on.least / 2


@dataclass(frozen=True)
class DecisionCurve:
    """What could be chosen before a contact, moment by moment; made by `find_decision_point`.

    The last moment of a kind is the latest of `steps` at which it holds: from the next step on it
    does not. These are latest moments, for wheels that turn and brakes that act at once: the real
    ones are earlier. None where no step has it, and where going on makes no contact: there is
    nothing to avoid.

    Examples
    --------
    >>> from crashrank import formats
    >>> curve = formats.find_decision_point("data/formats/crossing_poses.csv", step_s=0.25)
    >>> curve.other, curve.last_avoidable.time_s
    ('person', 1.75)
    """

    file: str
    """What was read; empty for scenarios that were given."""
    ego: str
    """What decides."""
    other: str
    """Actor that the ego hits if it goes on; without a contact the one that it passes closest."""
    contact_time_s: float | None
    """When it is hit, on the file's clock; None where the ego goes on without a contact."""
    measure: str
    """What is compared; lower is better."""
    measure_unit: str
    """Unit of the scores."""
    step_s: float
    """Time between steps."""
    steps: tuple[DecisionStep, ...]
    """By rising time, all before the contact or, without one, the closest approach."""

    @property
    def last_avoidable(self) -> DecisionStep | None:
        """Last step at which any manoeuvre avoids every contact."""
        return self._last(lambda step: step.avoidable)

    @property
    def last_avoidable_by_braking(self) -> DecisionStep | None:
        """Last step at which braking straight ahead avoids every contact."""
        return self._last(lambda step: step.avoidable_by_braking)

    @property
    def last_avoidable_by_steering(self) -> DecisionStep | None:
        """Last step at which steering at held speed avoids every contact."""
        return self._last(lambda step: step.avoidable_by_steering)

    @property
    def last_halvable(self) -> DecisionStep | None:
        """Last step at which a manoeuvre has at most half the score of going on."""
        return self._last(lambda step: step.halvable)

    def _last(self, holds: Callable[[DecisionStep], bool]) -> DecisionStep | None:
        if self.contact_time_s is None:
            return None
        return next((step for step in reversed(self.steps) if holds(step)), None)

    def _axis(self) -> str:
        """Return what is compared over the steps, and its unit."""
        if self.contact_time_s is None:
            return "least distance [m], 0 with a contact"
        return f"{self.measure} [{self.measure_unit}]"

    def _drawn(self, way: Choice | None) -> tuple[float, float]:
        """Return bounds on what is compared; nan without a manoeuvre or where it is not known."""
        if way is None:
            return math.nan, math.nan
        if self.contact_time_s is not None:
            return way.least, way.most
        metres = way.least_distance_m if way.avoids else 0.0
        return (math.nan, math.nan) if metres is None else (metres, metres)

    def _shown(self, way: Choice | None) -> str:
        """Return what is compared in nine characters, a bound where it is not known."""
        low, high = self._drawn(way)
        if math.isnan(high):
            return "-"
        return f"{high:.4g}" if low == high else f"<={high:.3g}"

    def _note(self) -> str:
        return NOTHING_TO_AVOID if self.contact_time_s is None else AT_ONCE

    def _before_contact_s(self, step: DecisionStep) -> float:
        return (self.contact_time_s or 0.0) - step.time_s

    def _going_on(self) -> str:
        """Return what going on leads to, without the ego."""
        if self.contact_time_s is not None:
            return f"hits {self.other} at {self.contact_time_s:.2f} s"
        nearest = least_distant(step.going_on for step in self.steps)
        return "goes on without a contact" + ("" if nearest is None else _passing(nearest))

    def _decisions(self) -> Iterator[tuple[str, str, DecisionStep | None, Choice | None]]:
        """Return key, text, step and choice of each last moment."""
        for key, text, step, way in (
            ("avoidable", "avoidable", self.last_avoidable, "best"),
            ("by_braking", "by braking", self.last_avoidable_by_braking, "braking"),
            ("by_steering", "by steering", self.last_avoidable_by_steering, "steering"),
            ("halvable", "half the harm", self.last_halvable, "best"),
        ):
            yield key, text, step, None if step is None else getattr(step, way)

    def to_dict(self) -> dict[str, Any]:
        """Return plain dicts and lists: the members, the last moments, and a note on them."""
        last = {
            key: None
            if step is None or choice is None
            else {
                "time_s": step.time_s,
                "before_contact_s": self._before_contact_s(step),
                "choice": dataclasses.asdict(choice),
            }
            for key, _, step, choice in self._decisions()
        }
        members = dataclasses.asdict(self)
        steps = members.pop("steps")
        return {**members, "note": self._note(), "last": last, "steps": steps}

    def to_json(self) -> str:
        """Return `to_dict` as JSON text."""
        return json.dumps(self.to_dict(), ensure_ascii=False, allow_nan=False)

    def lines(self) -> list[str]:
        """Return the last moments and the table of all steps as text."""
        found = [
            f"{self.ego} {self._going_on()}; {self._axis()}, steps of {self.step_s:g} s; "
            f"{self._note()}"
        ]
        for _, text, step, choice in self._decisions():
            if self.contact_time_s is None:
                break
            if step is None or choice is None:
                found.append(f"last {text}: at no step")
                continue
            away = ", leaves the road" if choice.leaves_road else ""
            found.append(
                f"last {text}: {step.time_s:.2f} s, {self._before_contact_s(step):.2f} s "
                f"before the contact: {choice.candidate}{away}{_passing(choice)}"
            )
        found.append("   time_s  going on     least   braking  steering  least harmful")
        for each in self.steps:
            ways = (each.going_on, each.best, each.braking, each.steering)
            numbers = " ".join(f"{self._shown(way):>9}" for way in ways)
            way = f"{each.best.candidate}{_passing(each.best)}"
            found.append(f"{each.time_s:9.2f} {numbers}  {way}")
        return found

    def __str__(self) -> str:
        """Return `lines` as one text."""
        return "\n".join(self.lines())

    def plot(self) -> Figure:
        """Draw the scores over time with the last moments marked; needs matplotlib."""
        try:
            from .._figure import NotebookFigure
        except ImportError:
            raise missing("matplotlib", "notebook") from None
        figure = NotebookFigure(figsize=(9, 4.2), layout="constrained")
        axes = figure.subplots()
        times = [step.time_s for step in self.steps]
        for label, member in (
            ("going on", "going_on"),
            ("braking", "braking"),
            ("steering", "steering"),
            ("least", "best"),
        ):
            ways = [getattr(step, member) for step in self.steps]
            low, high = zip(*map(self._drawn, ways), strict=True)
            colour = _COLOURS[label]
            axes.plot(times, high, marker=".", color=colour, label=label)
            axes.fill_between(times, low, high, color=colour, alpha=0.2, linewidth=0)
        marks: dict[float, list[str]] = {}
        for _, text, moment, _ in self._decisions():
            if moment is not None:
                marks.setdefault(moment.time_s, []).append(text)
        for at_s, texts in marks.items():
            axes.axvline(at_s, color="#8a8f98", linewidth=1, linestyle="--")
            axes.text(
                at_s, 0.98, f"last {', '.join(texts)} ", rotation=90, ha="right", va="top",
                fontsize="small", transform=axes.get_xaxis_transform(),
            )  # fmt: skip
        if self.contact_time_s is not None:
            axes.axvline(self.contact_time_s, color="black", linewidth=1.5)
        axes.set_xlabel(f"time [s]; {self.ego} {self._going_on()}")
        axes.set_ylabel(self._axis())
        axes.legend(loc="center left", fontsize="small")
        return figure


def least_distant(choices: Iterable[Choice]) -> Choice | None:
    """Return the one that passes an actor closest; None where none passes any within 50 m."""
    known = ((each.least_distance_m, each) for each in choices)
    passing = [(metres, each) for metres, each in known if metres is not None]
    return min(passing, key=lambda pair: pair[0])[1] if passing else None


def _passing(way: Choice) -> str:
    """Return how far a manoeuvre without a contact stays from the nearest actor."""
    if not way.avoids or way.least_distance_m is None:
        return ""
    return f", passes {way.least_distance_m:.2f} m from {way.nearest}"
