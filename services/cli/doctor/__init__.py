"""`sparge doctor`: what of an installation or of a running backend is wrong, and what to do."""
