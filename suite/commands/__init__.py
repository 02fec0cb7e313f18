"""The commands of ``kbga-bench``, by what they are about; each parses, calls, prints."""
