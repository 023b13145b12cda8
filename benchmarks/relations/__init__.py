"""Relations learned from a few demonstrations, measured against true geometry."""
