"""The names of the sampling-based planners, and of the ways to steer a base."""

COMPILED = "compiled"
"""RRT-Connect over the compiled collision kernel."""

OMPL = "ompl"
"""OMPL's RRTConnect, which asks the same kernel edge by edge; the reference."""

PLANNERS = (COMPILED, OMPL)

STEERINGS = ("se2", "reeds-shepp", "differential")
STEERINGS_OF = {
    "omnidirectional": STEERINGS,
    "fixed": STEERINGS,
    "differential": ("differential", "reeds-shepp"),
    "car": ("reeds-shepp",),
}
"""How a base with each drive can move; first its usual way."""

"""How a base may move: in any direction, like a car, or turning on the spot and straight ahead."""
