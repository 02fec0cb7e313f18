"""What rows say, as numbers: curves, tests, intervals, which rows may be compared."""
