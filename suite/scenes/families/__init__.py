"""Families of scenes: generators with few parameters, one in each file. See :mod:`.instance`."""
