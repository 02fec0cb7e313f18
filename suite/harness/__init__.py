"""Running a matrix: what to run, one run, and its process."""
