"""A second engine beside the planner's: pybullet, to judge plans and to let them run in physics."""
