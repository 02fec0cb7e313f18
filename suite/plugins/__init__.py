"""Other people's planners: found, checked, given their settings, hashed."""
