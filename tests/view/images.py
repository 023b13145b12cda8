from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image


def pixels(file: Path) -> np.ndarray:
    """A picture, or the first of a moving one: rows x columns x RGB in [0, 255]."""
    with Image.open(file) as image:
        return np.asarray(image.convert("RGB"), dtype=float)
