"""The bundled sample views: our own objects, seen by our own camera.

`python -m experiments.samples` writes them anew, the same every time.
"""
