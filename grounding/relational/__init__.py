"""Our groundings: poses and scenes described by how bodies stand to each other, not to the world."""
