"""A construct of a mesh format in a small file, and its surface by hand count."""

from dataclasses import dataclass
from typing import Any

Point = tuple[float, float, float]

# A box of 4 x 2 x 1 with a corner at the origin: 12 triangles, 28 m2. Its faces look outwards.
SIZE: Point = (4.0, 2.0, 1.0)
CORNERS: list[Point] = [
    (0, 0, 0), (4, 0, 0), (4, 2, 0), (0, 2, 0), (0, 0, 1), (4, 0, 1), (4, 2, 1), (0, 2, 1),
]
QUADS: list[tuple[int, ...]] = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
TRIANGLES = [t for a, b, c, d in QUADS for t in ((a, b, c), (a, c, d))]

# A plate of 3 x 3 with a hole of 1 x 1, which an edge there and back joins to the outline: 8 m2.
PLATE: list[Point] = [
    (0, 0, 0), (3, 0, 0), (3, 3, 0), (0, 3, 0), (1, 1, 0), (1, 2, 0), (2, 2, 0), (2, 1, 0),
]
PLATE_OUTLINE: tuple[int, ...] = (0, 1, 2, 3, 0, 4, 5, 6, 7, 4)


@dataclass
class Row:
    """A file and what is expected of it: the default is the box."""

    name: str
    construct: str
    content: bytes | str
    triangles: int = 12
    area: float = 28.0
    low: Point = (0.0, 0.0, 0.0)
    high: Point = SIZE
    parts: int = 1
    refused: str = ""  # words of the message with which crashrank refuses it
    warned: str = ""  # words of its warning
    listed: str = ""  # how crashrank differs from the format's text: a limit that the guide lists

    @property
    def format(self) -> str:
        """The file name's extension."""
        return self.name.rsplit(".", 1)[1]

    def bytes(self) -> bytes:
        """The file's content."""
        return self.content if isinstance(self.content, bytes) else self.content.encode()


def moved(by: Point) -> dict[str, Any]:
    """Bounds of the box moved."""
    x, y, z = by
    return {"low": by, "high": (x + SIZE[0], y + SIZE[1], z + SIZE[2])}


def lines(prefix: str, points: list[Point]) -> str:
    """A line for each point."""
    return "".join(prefix + " ".join(f"{x:g}" for x in point) + "\n" for point in points)
