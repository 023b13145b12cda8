"""Geometric wing: bodies, robot, collisions, motions, streams; it knows no search."""
