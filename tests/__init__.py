"""The tests mirror the modules; `python -m pytest` runs them from the root of the checkout."""

import os

# Small matrices are slower on several threads, most of all beside other processes. NumPy looks
# when it is loaded, so this stands before every other import of a test.
os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
