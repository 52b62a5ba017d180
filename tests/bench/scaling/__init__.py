"""What a request costs each service, and how many pods a rate of requests needs.

`python -m tests.bench.scaling` runs every service as a process of its own.
"""
