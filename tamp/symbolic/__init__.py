"""Symbolic wing: PDDL, heuristic search, algorithms over streams; it knows no geometry."""
