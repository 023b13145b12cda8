"""Stability: convex hulls, centres of mass, and the stable poses of a body."""
