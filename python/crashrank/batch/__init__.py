"""Many scenarios: a table of them ranked by one function, and the program ``crashrank-batch``.

`rank_table` maps a table of scenarios to a table of rankings; every engine that maps tables can
call it. ``crashrank-batch`` does so for folders and files, with processes or Ray, and writes parts
that a later run does not repeat. Both need ``crashrank[arrow]``.
"""

from __future__ import annotations

from ._hashes import result_hash
from ._table import rank_table, result_schema

__all__ = ["rank_table", "result_hash", "result_schema"]
