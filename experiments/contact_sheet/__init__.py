"""A picture of the catalogue, drawn by `python -m experiments.contact_sheet`."""
