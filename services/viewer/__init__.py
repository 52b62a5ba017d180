"""The page in the browser: ask, look, turn, try."""
