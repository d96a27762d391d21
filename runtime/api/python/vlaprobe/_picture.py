"""Pictures that show themselves in notebooks."""

from __future__ import annotations

import base64
import html
import struct
import zlib
from typing import Any, Optional

import numpy as np


def png_of(rgb: np.ndarray) -> bytes:
    """uint8 (height, width, 3) as the bytes of a PNG file."""
    height, width, _ = rgb.shape
    lines = np.zeros((height, 1 + width * 3), np.uint8)  # each begins with its filter: none
    lines[:, 1:] = np.ascontiguousarray(rgb).reshape(height, width * 3)

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(lines.tobytes(), 6)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", body) + chunk(b"IEND", b"")


class Picture(np.ndarray):
    """uint8 (height, width, 3), as any array; a notebook that is given one shows it. What is computed from it is one, too."""

    def png(self) -> bytes:
        """As a file."""
        return png_of(np.asarray(self))

    def save(self, path: Any) -> None:
        """Writes a .png file."""
        with open(path, "wb") as file:
            file.write(self.png())

    def _repr_png_(self) -> Optional[bytes]:
        """For notebooks; None of what is no picture any more, such as a row of one."""
        if self.dtype != np.uint8 or self.ndim != 3 or self.shape[2] != 3 or 0 in self.shape:
            return None
        return self.png()


def image_tag(rgb: np.ndarray, words: str = "") -> str:
    """A picture within HTML."""
    data = base64.b64encode(png_of(rgb)).decode()
    return f'<img alt="{html.escape(words)}" title="{html.escape(words)}" src="data:image/png;base64,{data}">'
