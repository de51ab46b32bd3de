"""Progress on a terminal: one line with rate and time left."""

from __future__ import annotations

import sys
import time
from typing import TextIO


class Progress:
    """Counts rows; draws a line at most four times a second where the stream is a terminal.

    Rows that were there already count as done but not in the rate.
    """

    def __init__(self, rows: int, stream: TextIO | None = None) -> None:
        self._stream = sys.stderr if stream is None else stream
        self._terminal = self._stream.isatty()
        self._rows = rows
        self._started = time.monotonic()
        self._drawn = 0.0
        self._width = 0
        self.found = 0
        """Rows that were there already."""
        self.ranked = 0
        """Rows that were ranked now."""
        self.errors = 0
        """Rows with an error, of both kinds."""

    def add(self, rows: int, errors: int, was_there: bool) -> None:
        """Count rows of a part."""
        self.errors += errors
        if was_there:
            self.found += rows
        else:
            self.ranked += rows
        self._draw()

    @property
    def seconds(self) -> float:
        """Time since the start."""
        return time.monotonic() - self._started

    @property
    def rate(self) -> float:
        """Scenes ranked in a second."""
        return self.ranked / max(self.seconds, 1e-9)

    def text(self) -> str:
        """Return the line."""
        done = self.found + self.ranked
        text = f"{done} of {self._rows} scenes"
        if self.errors:
            text += f", {self.errors} with an error"
        if self.ranked:
            left = (self._rows - done) / self.rate
            text += f", {self.rate:.3g} a second, {duration(left)} left"
        return text

    def _draw(self) -> None:
        now = time.monotonic()
        if not self._terminal or now - self._drawn < 0.25:
            return
        self._drawn = now
        text = self.text()
        self._stream.write("\r" + text.ljust(self._width))
        self._stream.flush()
        self._width = len(text)

    def say(self, message: str) -> None:
        """Write a message on a line of its own."""
        self.clear()
        self._stream.write(message + "\n")
        self._stream.flush()

    def clear(self) -> None:
        """Remove the line."""
        if self._width:
            self._stream.write("\r" + " " * self._width + "\r")
            self._stream.flush()
            self._width = 0


def duration(seconds: float) -> str:
    """Return a time as "1 h 02 min", "3 min 05 s" or "12 s"."""
    whole = round(seconds)
    if whole >= 3600:
        return f"{whole // 3600} h {whole % 3600 // 60:02} min"
    if whole >= 60:
        return f"{whole // 60} min {whole % 60:02} s"
    return f"{whole} s"
