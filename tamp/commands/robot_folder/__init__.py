"""Making robots: from a URDF to a robot's folder."""
