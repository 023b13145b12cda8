"""Judge plan files independently: own semantics, an engine's kinematics and collisions."""
