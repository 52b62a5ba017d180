"""How well the parts that are recovered are the object's parts."""
