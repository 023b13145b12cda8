"""Instantiate streams optimistically: placeholders for their outputs, the task over them."""
