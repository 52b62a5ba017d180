"""How much is made up, and from which seed: `make fuzz` asks for more than `make test`."""

from __future__ import annotations

import os

CASES = int(os.environ.get("SPARGE_FUZZ_CASES", "200"))
SEED = int(os.environ.get("SPARGE_FUZZ_SEED", "7"))
