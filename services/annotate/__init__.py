"""`sparge annotate`: folders of clouds -> Parquet tables of regions and grasps.

The driver reads files and writes tables; workers ask the backend. What a module
needs beside the backend is in the extra `annotate`.
"""
