"""The inner loops of the heuristics: the one place of the symbolic half that knows numpy and numba."""
