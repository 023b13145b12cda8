"""Scenes as frozen data: poses, shapes, bodies, surfaces, the room."""
