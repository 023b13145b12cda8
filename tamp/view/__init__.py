"""Scenes and plans to look at: in a browser, as a page of its own, as pictures."""
