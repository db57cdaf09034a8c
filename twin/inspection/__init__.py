"""Mesh in, deviations out. Uses neither the controller nor the machine: any mesh will do.

The whole way is `twin.inspection.inspection.inspect`; the package itself imports nothing, so that whoever
only needs a nominal or a tolerance does not load what measures.
"""
