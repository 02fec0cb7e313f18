"""Plain images: what is dark is occupied."""

from pathlib import Path

from suite.errors import SceneError
from suite.scenes.maps.drawing import Drawing
from suite.scenes.maps.options import MapOptions
from suite.scenes.maps.pixels import drawing_of
from suite.scenes.maps.raster import read_raster

RESOLUTION = 1.0
"""Metres of a pixel, if nothing is said."""
THRESHOLD = 0.5
"""Share of black from which a pixel is occupied, if nothing is said."""


def read_image(path: Path, options: MapOptions) -> Drawing:
    """Read an image as a map: its lower left corner lies at (0, 0), and y points up.

    A pixel's share of black is 1 without the mean of its red, green and blue; what it lacks in
    opacity is white, as on paper.

    Raises
    ------
    SceneError
        If it can't be read, or the threshold is above 1.
    """
    resolution = RESOLUTION if options.resolution is None else options.resolution
    threshold = THRESHOLD if options.threshold is None else options.threshold
    if not 0.0 < threshold <= 1.0:
        raise SceneError(
            f"{path.name}: threshold is {threshold:g}. Give the share of black from which a pixel "
            "is occupied, above 0 and up to 1."
        )
    raster = read_raster(path, path.name)
    black = raster.darkness
    if raster.opacity is not None:
        black *= raster.opacity
    drawing = drawing_of(black >= threshold, resolution=resolution, simplify=options.simplify)
    height, width = black.shape
    return Drawing(
        drawing.workspace,
        drawing.obstacles,
        properties={
            "format": "image",
            "pixels": f"{width} x {height}",
            "resolution": resolution,
            "resolution_is": "assumed" if options.resolution is None else "given",
            "threshold": threshold,
        },
    )
