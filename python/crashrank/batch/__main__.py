"""``python -m crashrank.batch``: the program ``crashrank-batch``."""

import sys

from ._command import main

if __name__ == "__main__":
    sys.exit(main())
