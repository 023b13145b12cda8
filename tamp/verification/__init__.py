"""An independent judge of plan files: its own semantics, pybullet's kinematics and collision detection."""
