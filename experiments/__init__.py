"""What measures and feeds SPaRGE from outside: the object catalogue, the camera, sample views."""
