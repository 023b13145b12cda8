"""Motion planning: straight lines, RRT-Connect, shortcuts, and the timing of a path."""
