"""The rules on parts that are right, cut in two, or recovered: `python -m tests.bench.rules`."""
