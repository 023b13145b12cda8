"""Robots as data: kinematics, inverse kinematics, reachability, sphere covers."""
