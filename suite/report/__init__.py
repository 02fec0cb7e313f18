"""Tables and figures from a store's rows."""
