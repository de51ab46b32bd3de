"""JSON objects whose members are attributes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any


class Record(Mapping[str, Any]):
    """A JSON object: its members are attributes and items, objects inside are records."""

    __slots__ = ("_members",)

    _members: dict[str, Any]

    def __init__(self, members: dict[str, Any]) -> None:
        object.__setattr__(self, "_members", members)

    def __getattr__(self, name: str) -> Any:
        if not name.startswith("_") and name in self._members:
            return wrap(self._members[name])
        raise AttributeError(
            f"{type(self).__name__} has no attribute {name!r}", name=name, obj=self
        )

    def __setattr__(self, name: str, value: object) -> None:
        """Refuse: a record never changes."""
        raise AttributeError(f"{type(self).__name__} cannot be changed")

    def __getitem__(self, key: str) -> Any:
        return wrap(self._members[key])

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._members})

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._members!r})"

    def __reduce__(self) -> tuple[object, tuple[object, ...]]:
        return type(self), (self._members,)

    def __hash__(self) -> int:
        return hash(repr(self._members))

    def to_dict(self) -> dict[str, Any]:
        """Return a copy as plain dicts and lists."""
        copy: dict[str, Any] = _copy(self._members)
        return copy


def wrap(value: Any) -> Any:
    """Return objects as records, lists as tuples of wrapped members, all else as it is."""
    if isinstance(value, dict):
        return Record(value)
    if isinstance(value, list):
        return tuple(wrap(member) for member in value)
    return value


def _copy(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _copy(member) for key, member in value.items()}
    if isinstance(value, list):
        return [_copy(member) for member in value]
    return value
