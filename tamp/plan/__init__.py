"""Plan files: write, read and open them, find their sources; the schemas lie here."""
