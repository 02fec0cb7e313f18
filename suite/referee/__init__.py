"""The referee: paths judged, claims read, one clock."""
