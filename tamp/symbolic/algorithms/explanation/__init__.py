"""Explain why there is no plan: unachievable facts, conflicting goals, what failed."""
