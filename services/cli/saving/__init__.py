"""`--save FILE`: an answer as a picture, a page or a film; the suffix says which."""

from services.cli.saving.kinds import Saved, saved, wants_film

__all__ = ["Saved", "saved", "wants_film"]
