"""Heuristic forward search over instantiated tasks: A*, weighted A*, greedy; mutex proofs."""
