"""Images as arrays: how bright each pixel is, and how opaque."""

import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, UnidentifiedImageError

from suite.errors import SceneError
from suite.scenes.maps.text import one_line

KINDS = ("PNG", "PPM", "BMP", "JPEG", "TIFF")
"""Of images, as Pillow names them; PPM has PGM in it."""

MOST_PIXELS = 50_000_000
"""Of an image, 7,000 x 7,000 for example: a small file may hold far more than there is memory."""

SIXTEEN_BITS = ("I;16", "I;16B", "I;16L", "I;16N")


@dataclass(frozen=True, slots=True, eq=False)
class Raster:
    """An image, the upper row first.

    level : (rows, columns) unsigned integers, the sum of red, green and blue; 0 is black.
    white : the level of white.
    opacity : (rows, columns) float64, 0 transparent, 1 opaque; None if it says nothing of it.
    """

    level: NDArray[np.unsignedinteger]
    white: int
    opacity: NDArray[np.float64] | None = None

    @property
    def brightness(self) -> NDArray[np.float64]:
        """Share of white, (rows, columns)."""
        return self.level / np.float64(self.white)

    @property
    def darkness(self) -> NDArray[np.float64]:
        """Share of black, (rows, columns): rounded once, so that 51 of 255 are 0.2."""
        return (self.white - self.level) / np.float64(self.white)


def read_raster(path: Path, where: str) -> Raster:
    """Read an image.

    Parameters
    ----------
    path : Path
    where : str
        What names it, for errors.

    Raises
    ------
    SceneError
        If it can't be read, is no image of those kinds, or too large.
    """
    try:
        with warnings.catch_warnings():
            # What Pillow warns of: sizes, of which our own limit is lower, and oddities of TIFF.
            warnings.simplefilter("ignore")
            with Image.open(path, formats=KINDS) as image:
                _check_size(image, where)
                return _raster(image, where)
    except UnidentifiedImageError as error:
        raise SceneError(f"{where}: is no image. Give one of {', '.join(KINDS)}.") from error
    except Image.DecompressionBombError as error:
        raise SceneError(f"{where}: {_too_large('far too many pixels')}") from error
    except OSError as error:
        if error.errno is not None:
            raise SceneError(f"{where}: can't be read ({error.strerror}).") from error
        raise SceneError(_damaged(where, error)) from error
    except (ValueError, SyntaxError, TypeError, EOFError, LookupError, OverflowError) as error:
        # Each of Pillow's readers has its own way to say that a file is damaged.
        raise SceneError(_damaged(where, error)) from error


def _damaged(where: str, error: Exception) -> str:
    return f"{where}: is damaged, or cut off ({one_line(error)}). Save or copy it once more."


def _check_size(image: Image.Image, where: str) -> None:
    if image.width * image.height > MOST_PIXELS:
        raise SceneError(f"{where}: {_too_large(f'{image.width} x {image.height} pixels')}")


def _too_large(size: str) -> str:
    return f"has {size}: at most {MOST_PIXELS:,} can be read. Make it smaller, or cut it in parts."


def _raster(image: Image.Image, where: str) -> Raster:
    if image.mode in SIXTEEN_BITS or (image.mode == "I" and image.format in ("PNG", "PPM")):
        return Raster(np.asarray(image).astype(np.uint16), 65535)
    if image.mode in ("I", "F"):
        raise SceneError(
            f"{where}: its pixels are of 32 bits, of which nothing says what is white. "
            "Save it in 8 or 16 bits."
        )
    if image.has_transparency_data:
        pixels = np.asarray(image.convert("RGBA"))
        return Raster(_sum(pixels[..., :3]), 765, pixels[..., 3] / 255.0)
    if image.mode in ("1", "L"):
        return Raster(np.asarray(image.convert("L")), 255)
    return Raster(_sum(np.asarray(image.convert("RGB"))), 765)


def _sum(channels: NDArray[np.uint8]) -> NDArray[np.uint16]:
    return channels.sum(axis=2, dtype=np.uint16)
