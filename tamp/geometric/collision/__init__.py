"""Collision checking of states and whole edges: compiled, with FCL where that is unsure."""
