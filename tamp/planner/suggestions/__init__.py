"""Suggest changes that would make an unsolvable problem solvable (`--why`)."""
