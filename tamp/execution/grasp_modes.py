"""The grasp modes: how a hand holds in physics."""

GRASPS = ("friction", "constraint")
"""By what its fingers press, or by a fixed joint that comes with closing."""
