"""Drawings of rankings: the plan of one candidate, and scores with intervals."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._checks import as_count
from ._errors import no_candidate

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from . import _core
    from ._ranking import RankedCandidate, Ranking

MARGIN_M = 8.0
PATH_POINTS = 60
EGO_COLOUR = "#0b6e99"
HIT_COLOUR = "#c0392b"
ACTOR_COLOUR = "#8a8f98"


def place_outline(outline: NDArray[np.float64], pose: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return an outline in the world: body coordinates turned and moved by (x, y, heading)."""
    x, y, heading = pose
    c, s = np.cos(heading), np.sin(heading)
    return np.asarray(outline @ np.array([[c, s], [-s, c]]) + [x, y])


def plot(ranking: Ranking, ranked: _core.Ranked, candidate: object, top: int) -> Figure:
    """Return a figure with the plan and the scores; see `Ranking.plot`."""
    from ._tables import missing

    try:
        from ._figure import NotebookFigure
    except ImportError:
        raise missing("matplotlib", "notebook") from None
    names = [each.candidate for each in ranking]
    if isinstance(candidate, str) and candidate not in names:
        raise no_candidate(candidate)
    place = names.index(candidate) if isinstance(candidate, str) else candidate or 0
    index = as_count(place, "candidate", -len(names), len(names) - 1)
    figure = NotebookFigure(figsize=(12, 4.8), layout="constrained")
    plan, scores = figure.subplots(1, 2, width_ratios=(3, 2))
    _draw_plan(plan, ranking, ranked, index)
    _draw_scores(scores, ranking, min(top, len(ranking)))
    return figure


def _draw_plan(axes: Axes, ranking: Ranking, ranked: _core.Ranked, index: int) -> None:
    row = ranking[index]
    end_s = row.time_of_impact_s
    until_s = ranked.horizon_s if end_s is None else end_s
    times = np.linspace(0.0, until_s, PATH_POINTS)
    ego = ranked.candidate_paths(times)[index]
    actors = ranked.actor_paths(times)
    corners = [place_outline(ranked.outline(-1), ego[-1])]
    axes.plot(ego[:, 0], ego[:, 1], color=EGO_COLOUR, linewidth=1)
    _fill(axes, place_outline(ranked.outline(-1), ego[0]), EGO_COLOUR, 0.15, "")
    _fill(axes, corners[0], EGO_COLOUR, 0.6, "ego")
    for i, body in enumerate(ranking.actors):
        path = actors[i]
        hit = body.name == row.other
        colour = HIT_COLOUR if hit else ACTOR_COLOUR
        if np.ptp(path, axis=0).max() > 0.01:
            axes.plot(path[:, 0], path[:, 1], color=colour, linewidth=1)
        outline = place_outline(ranked.outline(i), path[-1])
        _fill(axes, outline, colour, 0.6, body.name if hit else "")
        if hit:
            corners.append(outline)
    if row.contacts:
        x, y, _ = row.contacts[0].point_m
        axes.plot([x], [y], marker="*", color="black", markersize=10, linestyle="none")
    seen = np.concatenate([*corners, ego[:, :2]])
    low, high = seen.min(axis=0) - MARGIN_M, seen.max(axis=0) + MARGIN_M
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("x [m]")
    axes.set_ylabel("y [m]")
    when = f"contact after {end_s:.2f} s" if end_s is not None else f"no contact, {until_s:g} s"
    axes.set_title(f"{row.candidate}: {when}")
    axes.legend(loc="best", fontsize="small")


def _fill(axes: Axes, outline: NDArray[np.float64], colour: str, alpha: float, label: str) -> None:
    axes.fill(
        outline[:, 0],
        outline[:, 1],
        facecolor=colour,
        edgecolor=colour,
        alpha=alpha,
        label=label or None,
    )


def _draw_scores(axes: Axes, ranking: Ranking, top: int) -> None:
    shown = ranking[:top]
    places = np.arange(top)[::-1]
    for place, row in zip(places, shown, strict=True):
        low, high = row.score_interval
        axes.plot([low, high], [place, place], color=EGO_COLOUR, linewidth=2, alpha=0.5)
        if row.score is not None:
            axes.plot([row.score], [place], marker="o", color=EGO_COLOUR, linestyle="none")
    axes.set_yticks(places, [_label(row) for row in shown])
    axes.set_ylim(-0.5, top - 0.5)
    axes.set_xlabel(f"{ranking.measure} [{ranking.measure_unit}], with interval")
    axes.set_title(f"{top} of {len(ranking)} candidates" if top < len(ranking) else "candidates")
    axes.grid(axis="x", alpha=0.3)


def _label(row: RankedCandidate) -> str:
    name: Any = row.candidate
    return f"{row.rank}  {name if len(name) <= 28 else name[:27] + '…'}"
