"""One package per service; none imports another. `services.wiring` puts them together."""
