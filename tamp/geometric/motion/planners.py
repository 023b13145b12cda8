"""The names of the sampling-based planners, and of the ways to steer a base."""

COMPILED = "compiled"
"""RRT-Connect over the compiled collision kernel."""

OMPL = "ompl"
"""OMPL's RRTConnect, which asks the same kernel edge by edge; the reference."""

PLANNERS = (COMPILED, OMPL)

STEERINGS = ("se2", "reeds-shepp", "differential")
"""How a base may move: in any direction, like a car, or turning on the spot and straight ahead."""
