"""Plan as a library: files to a problem, a problem to a timed solution."""
