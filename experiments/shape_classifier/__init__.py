"""Train and measure the shape classifier of the primitive recovery (thesis A.1.2)."""
