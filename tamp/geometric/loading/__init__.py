"""Load a scene: YAML, meshes, URDF objects, furniture, where bodies stand at the start."""
