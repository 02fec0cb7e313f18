"""The result store: rows that are written once, kept, merged and named."""
