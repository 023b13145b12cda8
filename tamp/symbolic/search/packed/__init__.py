"""Lazy search over packed states, compiled: what `lazy` does, many times faster on large tasks."""
