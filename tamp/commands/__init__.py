"""Enter by the command line: one file a command, with its options and exit codes."""
