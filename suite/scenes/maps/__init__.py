"""Maps that others made, read as scenes: one file for each format."""
