"""Algorithms of task and motion planning over streams: adaptive, incremental, anytime."""
