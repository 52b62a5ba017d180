"""Load on a backend: closed and open loop, and a soak. `make load`, `make soak`."""
