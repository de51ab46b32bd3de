"""What the summary page says, gathered part by part: memory does not grow with the rankings."""

from __future__ import annotations

import heapq
from array import array
from collections import Counter
from pathlib import Path
from typing import Any, NamedTuple

from ._arrow import parquet
from ._page import page

MOST_FAILURES = 200
_COLUMNS = ["id", "status", "error", "error_code", "measure", "measure_unit", "best", "best_score"]


class Worst(NamedTuple):
    """A scene whose best candidate has a high score."""

    score: float
    id: str
    best: str
    measure: str
    part: int
    row: int
    report: str
    """File name of its report."""


class Summary:
    """Scores by measure, the worst scenes of each, and failures."""

    def __init__(self, most_worst: int) -> None:
        self._most_worst = most_worst
        self.scores: dict[str, array[float]] = {}
        """Best scores by measure and unit: "harm [persons]"."""
        self.failures: list[tuple[str, str]] = []
        """Ids and errors of the first failures."""
        self.codes: Counter[str] = Counter()
        """Failures by code."""
        self.unscored = 0
        """Rows whose best candidate has no score: the work budget ended them."""
        self._worst: dict[str, list[Worst]] = {}

    def add(self, index: int, path: Path) -> None:
        """Add a part."""
        rows = parquet().read_table(path, columns=[*_COLUMNS, "result_hash"], use_threads=False)
        for i, row in enumerate(rows.to_pylist()):
            if row["status"] != "ok":
                self.codes[row["error_code"]] += 1
                if len(self.failures) < MOST_FAILURES:
                    self.failures.append((row["id"], row["error"]))
            elif row["best_score"] is None:
                self.unscored += 1
            else:
                self._add_score(index, i, row)

    def _add_score(self, index: int, i: int, row: dict[str, Any]) -> None:
        measure = f"{row['measure']} [{row['measure_unit']}]"
        self.scores.setdefault(measure, array("d")).append(row["best_score"])
        report = f"{row['result_hash'][:16]}.html"
        worst = Worst(row["best_score"], row["id"], row["best"], measure, index, i, report)
        heap = self._worst.setdefault(measure, [])
        if len(heap) < self._most_worst:
            heapq.heappush(heap, worst)
        elif heap:
            heapq.heappushpop(heap, worst)

    def worst(self) -> list[Worst]:
        """Return the worst scenes of every measure, the worst first."""
        return [
            each for measure in sorted(self._worst) for each in sorted(self._worst[measure])[::-1]
        ]

    def page(self, outcome: dict[str, Any], reports: str, links: set[str]) -> str:
        """Return the summary as one HTML page; `links` are the reports that exist."""
        return page(self, outcome, reports, links)
