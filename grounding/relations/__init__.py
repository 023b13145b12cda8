"""Relations learned from a few demonstrations, over any bodies."""
