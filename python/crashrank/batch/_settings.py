"""What is asked of every scenario of a batch."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterable
from typing import Any

from .. import _core
from .._checks import as_count, as_path, as_text
from .._errors import NotFoundError
from .._scenario import _as_paths
from ._hashes import MISSING, file_hash, json_digest

MAX_WORK = 2**64 - 1


@dataclasses.dataclass(frozen=True)
class Settings:
    """Options of `crashrank.rank` that change answers, the same for every row.

    Deadlines are not among them: answers would depend on the machine.
    """

    measure: str | None = None
    risk: str | None = None
    infeasible: str = "demote"
    profile: str | None = None
    futures: int = 64
    work_budget: int | None = None
    allow: tuple[str, ...] = ()
    """Folders outside a scenario's own in which meshes may lie; not part of the hash."""

    @property
    def hash(self) -> str:
        """SHA-256 over all options, the profile by its content."""
        profile = None if self.profile is None else file_hash(self.profile)
        if profile == MISSING:
            raise NotFoundError(
                "not_found", str(self.profile), "", "cannot be read", "name a profile in JSON"
            )
        return json_digest(
            {
                "measure": self.measure,
                "risk": self.risk,
                "infeasible": self.infeasible,
                "profile": profile,
                "futures": self.futures,
                "work_budget": self.work_budget,
            }
        )

    def options(self) -> dict[str, Any]:
        """Return the keywords of `crashrank.rank`."""
        return {
            "measure": self.measure,
            "risk": self.risk,
            "infeasible": self.infeasible,
            "profile": self.profile,
            "futures": self.futures,
            "work_budget": self.work_budget,
        }


def make_settings(
    measure: object = None,
    risk: object = None,
    infeasible: object = "demote",
    profile: object = None,
    futures: object = 64,
    work_budget: object = None,
    allow: Iterable[object] = (),
) -> Settings:
    """Check types and return the settings; what names mean is checked by the first ranking."""
    return Settings(
        None if measure is None else as_text(measure, "measure"),
        None if risk is None else as_text(risk, "risk"),
        as_text(infeasible, "infeasible"),
        None if profile is None else as_path(profile, "profile"),
        as_count(futures, "futures", 1, _core.max_sampled_futures),
        None if work_budget is None else as_count(work_budget, "work_budget", 0, MAX_WORK),
        tuple(_as_paths(allow)),
    )
