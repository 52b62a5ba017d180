"""Name superquadrics cuboid, cylinder or sphere: criterion, methods, model (thesis A.1.2)."""
