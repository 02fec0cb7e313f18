"""The report: one self-contained page, made from a store."""
