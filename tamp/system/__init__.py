"""Serve the program itself: deadlines, signals, processes, files, progress, the terminal."""
