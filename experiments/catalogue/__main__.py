"""Print the tables of docs/catalogue.md: `python -m experiments.catalogue`."""

import sys

from experiments.catalogue.listing import object_table, refusal_table

if __name__ == "__main__":
    sys.stdout.write(f"{object_table()}\n{refusal_table()}")
