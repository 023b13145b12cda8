"""Relations of the user's own: ask their classifiers alike in planning, execution, judging."""
