"""The superquadric of one part, completed where the camera did not see it."""

from services.primitive_recovery.fitting.fit import PartFit
from services.primitive_recovery.fitting.part import fit_part

__all__ = ["PartFit", "fit_part"]
