"""Trajectories for other programs."""
