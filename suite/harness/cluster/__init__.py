"""Where runs are waited for: threads of this process, or the workers of a dask cluster."""
