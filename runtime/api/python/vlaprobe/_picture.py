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
    raw = np.zeros((height + 1, width * 3 + 3), np.int16)  # with a row above and a pixel to the left, of nothing
    raw[1:, 3:] = np.ascontiguousarray(rgb).reshape(height, width * 3)
    here, left, above, corner = raw[1:, 3:], raw[1:, :-3], raw[:-1, 3:], raw[:-1, :-3]
    guess = left + above - corner
    far = [np.abs(guess - left), np.abs(guess - above), np.abs(guess - corner)]
    paeth = np.where((far[0] <= far[1]) & (far[0] <= far[2]), left, np.where(far[1] <= far[2], above, corner))
    # Each row by the filter that leaves least, as the format's own advice has it.
    filtered = np.stack([here, here - left, here - above, here - (left + above) // 2, here - paeth]).astype(np.uint8)
    best = np.abs(filtered.astype(np.int8).astype(np.int16)).sum(2).argmin(0)
    lines = np.empty((height, 1 + width * 3), np.uint8)
    lines[:, 0] = best
    lines[:, 1:] = filtered[best, np.arange(height)]

    def chunk(kind: bytes, body: bytes) -> bytes:
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(lines.tobytes(), 9)
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


def image_tag(rgb: np.ndarray, words: str = "", most: int = 320) -> str:
    """A picture within HTML, made smaller by a whole factor where it is wider than `most`: a notebook keeps its bytes."""
    every = -(-rgb.shape[1] // most)
    high, wide = rgb.shape[0] // every, rgb.shape[1] // every
    blocks = np.asarray(rgb)[: high * every, : wide * every].reshape(high, every, wide, every, 3)
    small = (blocks.mean((1, 3)) + 0.5).astype(np.uint8)
    data = base64.b64encode(png_of(small)).decode()
    return f'<img alt="{html.escape(words)}" title="{html.escape(words)}" src="data:image/png;base64,{data}">'
