"""Streams of the cupboard's domain: grasps, placements, IK, motions, collision tests."""
