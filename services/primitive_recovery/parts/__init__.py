"""Cut a partial cloud where the object's parts meet, then fit each part."""
