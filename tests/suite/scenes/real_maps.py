"""Where the public maps lie, beside the checkout."""

from pathlib import Path

FOLDER = Path(__file__).resolve().parents[4] / "shared" / "maps"
MISSING = not FOLDER.is_dir()
REASON = "the public maps are not there: ../shared/maps beside the checkout"
