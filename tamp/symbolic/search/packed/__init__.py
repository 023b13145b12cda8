"""Lazy search over packed states, compiled: as `lazy`, many times faster on large tasks."""
