"""``python -m crashrank``: the console script ``crashrank``."""

import sys

from ._program import main

if __name__ == "__main__":
    sys.exit(main())
