"""Readers of mesh files, a module a format; `others` reads with trimesh what the short ways leave.

Each takes the path and returns a `raw.Raw`, or None for a file that is not of the plain kind it reads.
"""
