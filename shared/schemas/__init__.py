"""The messages of every service, one family per file, and the routes that carry them."""
