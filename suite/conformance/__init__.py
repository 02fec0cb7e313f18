"""The plugin contract as checks: one small function for each rule, for any author to run."""
