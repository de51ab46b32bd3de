"""Access to pyarrow, which is an extra."""

from __future__ import annotations

from typing import Any

from .._tables import missing


def arrow() -> Any:
    """Return the module pyarrow, or raise `NotFoundError` that names the extra."""
    try:
        import pyarrow
    except ImportError:
        raise missing("pyarrow", "arrow") from None
    return pyarrow


def parquet() -> Any:
    """Return the module pyarrow.parquet."""
    arrow()
    import pyarrow.parquet

    return pyarrow.parquet


def compute() -> Any:
    """Return the module pyarrow.compute."""
    arrow()
    import pyarrow.compute

    return pyarrow.compute
