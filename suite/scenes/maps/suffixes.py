"""By what suffixes maps are told from names; :mod:`suite.scenes.maps.formats` says what reads each.

Apart from it, so that a name is understood without any of the libraries that read maps.
"""

MAP_SUFFIXES: tuple[str, ...] = (".wkt",)
