"""Samplers of placements (hand-made, learned, the user's) and the mixture that shares work."""
