"""Bind a skeleton: collect an optimistic plan's stream calls, backtrack over their values."""
