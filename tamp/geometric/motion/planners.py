"""The names of the sampling-based planners."""

COMPILED = "compiled"
"""RRT-Connect over the compiled collision kernel."""

OMPL = "ompl"
"""OMPL's RRTConnect, which asks the same kernel edge by edge; the reference."""

PLANNERS = (COMPILED, OMPL)
