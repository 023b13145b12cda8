"""Judge plan files independently: own semantics, pybullet's kinematics and collision detection."""
