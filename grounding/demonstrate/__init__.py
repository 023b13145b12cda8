"""Demonstrations in the browser: scenes, what a hand does in them, files of what holds in them."""
