"""What choices cost: harm and regret by the stored answers."""

from __future__ import annotations

import csv
import io
import operator
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from .._checks import as_count
from .._errors import BadInputError, usage
from ._data import Benchmark, StoredAnswer, candidate_names, load, written

Chooser = Callable[[dict[str, Any]], object]
AT_RANDOM = "at random"
"""Chooser without choices: the mean over all candidates."""


class Row(NamedTuple):
    """A chooser's choice in one scene; harm in persons."""

    scene: str
    chooser: str
    choice: str
    """Empty for the mean over all candidates."""
    harm_persons: float
    lowest: float
    highest: float
    regret_persons: float
    """Harm above that of the scene's least harmful candidate."""
    best: float
    """1 where no candidate has less harm, else 0; a share for the mean over all."""
    may_be_best: float
    """The same for candidates that are first in one sample of what is not known, or more."""


def score(choose: Chooser, *, scenes: int | None = None, name: str = "yours") -> list[Row]:
    """Score a chooser by the stored answers; nothing is ranked.

    Parameters
    ----------
    choose : callable
        Takes a scene, a dict with the keys of a scenario file that it may change, and returns
        the name of one of ``scene["candidates"]["listed"]`` or its index.
    scenes : int, optional
        The first scenes alone; one of each situation comes first. Default: all.
    name : str
        What the rows call the chooser.

    Returns
    -------
    list of Row
        One for each scene.

    Raises
    ------
    BadInputError
        Where `choose` raises, or returns no candidate of the scene.
    """
    stored = load()
    if scenes is not None:
        stored = stored.first(as_count(scenes, "scenes", 1, len(stored.lines)))
    return score_with(stored, choose, name)


def score_with(stored: Benchmark, choose: Chooser, name: str) -> list[Row]:
    """Score a chooser on these scenes."""
    rows = []
    for scene, answers in zip(stored.scenes, stored.answers, strict=True):
        title, names = str(scene["name"]), candidate_names(scene)
        try:
            choice = choose(scene)
        except (Exception, SystemExit) as error:
            text = " ".join(str(error).split())
            raise BadInputError(
                "bad_input", name, f"scene {title!r}", f"raised {type(error).__name__}: {text}",
                "call it with that scene of crashrank.benchmark.load().scenes",
            ) from error  # fmt: skip
        rows.append(_row(name, answers, [answers[_index(choice, names, name, title)]]))
    return rows


def stored_rows(stored: Benchmark | None = None) -> list[Row]:
    """Return the rows of the simple choosers that are stored, and of choosing at random."""
    stored = load() if stored is None else stored
    rows = []
    for chooser in stored.choosers:
        for answers in stored.answers:
            taken = [answer for answer in answers if chooser in answer.chosen_by]
            rows.append(_row(chooser, answers, taken))
    return rows + [_row(AT_RANDOM, answers, answers) for answers in stored.answers]


def summary(rows: Iterable[Row]) -> dict[str, dict[str, Any]]:
    """Return for each chooser mean and worst regret, and the shares of best choices.

    Returns
    -------
    dict
        By chooser: ``scenes``, ``mean_regret_persons``, ``best_share``, ``may_be_best_share``,
        ``worst_regret_persons`` and ``worst_scene``.
    """
    groups: dict[str, list[Row]] = {}
    for row in rows:
        groups.setdefault(row.chooser, []).append(row)
    found = {}
    for chooser, group in groups.items():
        worst = max(group, key=lambda row: row.regret_persons)
        found[chooser] = {
            "scenes": len(group),
            "mean_regret_persons": sum(row.regret_persons for row in group) / len(group),
            "best_share": sum(row.best for row in group) / len(group),
            "may_be_best_share": sum(row.may_be_best for row in group) / len(group),
            "worst_regret_persons": worst.regret_persons,
            "worst_scene": worst.scene,
        }
    return found


def table(rows: Iterable[Row]) -> str:
    """Return the summary as text for people."""
    lines = ["mean regret   best  may be best  worst regret  chooser"]
    for chooser, found in summary(rows).items():
        lines.append(
            f"{found['mean_regret_persons']:11.4f} {100 * found['best_share']:4.0f} %"
            f" {100 * found['may_be_best_share']:10.0f} % {found['worst_regret_persons']:13.3f}"
            f"  {chooser} (worst in {found['worst_scene']!r})"
        )
    return "\n".join(lines)


def rows_csv(rows: Iterable[Row]) -> str:
    """Return rows as CSV text."""
    return _csv(Row._fields, rows)


def summary_csv(rows: Iterable[Row]) -> str:
    """Return the summary as CSV text."""
    found = summary(rows)
    head = ("chooser", *next(iter(found.values()), {}))
    return _csv(head, [(chooser, *row.values()) for chooser, row in found.items()])


def _csv(head: Iterable[object], rows: Iterable[Iterable[object]]) -> str:
    text = io.StringIO()
    out = csv.writer(text, lineterminator="\n")
    out.writerow(head)
    for row in rows:
        out.writerow(written(x) if isinstance(x, float) else x for x in row)
    return text.getvalue()


def _row(chooser: str, answers: Iterable[StoredAnswer], taken: Iterable[StoredAnswer]) -> Row:
    """Return the row of candidates that are equally likely to be taken."""
    chosen, least = list(taken), min(answer.harm_persons for answer in answers)
    count = len(chosen)
    harm, lowest, highest = (
        sum(values) / count for values in zip(*(answer[2:5] for answer in chosen), strict=True)
    )
    best = sum(answer.harm_persons <= least for answer in chosen) / count
    may = sum(answer.best_place == 1 for answer in chosen) / count
    choice = chosen[0].candidate if chooser != AT_RANDOM else ""
    return Row(chosen[0].scene, chooser, choice, harm, lowest, highest, harm - least, best, may)


def _index(choice: object, names: list[str], chooser: str, scene: str) -> int:
    """Return the index of a choice, a name or an index."""
    if isinstance(choice, str):
        if choice in names:
            return names.index(choice)
    elif not isinstance(choice, bool):
        try:
            index = operator.index(choice)  # type: ignore[arg-type]
        except TypeError:
            index = -1
        if 0 <= index < len(names):
            return index
    raise BadInputError(
        "bad_input", chooser, f"scene {scene!r}", f"returned {repr(choice)[:80]}",
        f"return one of {', '.join(map(repr, names))}, or an index below {len(names)}",
    )  # fmt: skip


def chooser_of(text: str) -> Chooser:
    """Return the function that MODULE:FUNCTION names."""
    import importlib
    import sys

    module_name, _, name = text.partition(":")
    if not module_name or not name:
        raise usage("--chooser", f"is {text!r}", "write MODULE:FUNCTION, as planner:choose")
    if "" not in sys.path:
        sys.path.insert(0, "")
    try:
        found: object = importlib.import_module(module_name)
        for part in name.split("."):
            found = getattr(found, part)
    except (Exception, SystemExit) as error:
        reason = " ".join(f"{type(error).__name__}: {error}".split())
        raise usage(
            "--chooser", f"{text} cannot be imported: {reason}",
            "run it where MODULE.py lies, or put its folder into PYTHONPATH",
        ) from error  # fmt: skip
    if not callable(found):
        raise usage("--chooser", f"{text} is no function", "name a function of one argument")
    return found
