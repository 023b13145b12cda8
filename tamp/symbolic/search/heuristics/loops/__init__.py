"""The inner loops of the heuristics, run as plain Python or compiled."""
