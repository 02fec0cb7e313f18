"""The five operators of paper II-C, one file each."""
