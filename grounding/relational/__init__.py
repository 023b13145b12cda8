"""Our groundings: poses and scenes by how bodies stand to each other, not to the world."""
