"""A TFDS folder of RLDS episodes read with the standard library alone, as one JSON object: python3 read_rlds.py DIR.

Every checksum is computed, every key of features.json has to be there with its length; pictures are decoded from PNG
and given as the SHA-256 of their bytes, in hex.
"""
import hashlib
import json
import pathlib
import struct
import sys
import zlib


def crc32c(data):
    value = 0xFFFFFFFF
    for byte in data:
        value = TABLE[(value ^ byte) & 0xFF] ^ (value >> 8)
    return value ^ 0xFFFFFFFF


TABLE = []
for start in range(256):
    for _ in range(8):
        start = (start >> 1) ^ (0x82F63B78 if start & 1 else 0)
    TABLE.append(start)
assert crc32c(b"123456789") == 0xE3069283


def masked(data):
    crc = crc32c(data)
    return (((crc >> 15) | (crc << 17)) + 0xA282EAD8) & 0xFFFFFFFF


def records(path):
    data = path.read_bytes()
    at = 0
    while at < len(data):
        (size,), (check,) = struct.unpack_from("<Q", data, at), struct.unpack_from("<I", data, at + 8)
        assert check == masked(data[at : at + 8]), f"{path}: length at {at}"
        payload = data[at + 12 : at + 12 + size]
        assert struct.unpack_from("<I", data, at + 12 + size)[0] == masked(payload), f"{path}: record at {at}"
        at += size + 16
        yield payload


def varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 0x7F) << shift
        shift += 7
        if byte < 0x80:
            return value, at


def fields(data):
    at = 0
    while at < len(data):
        key, at = varint(data, at)
        assert key & 7 == 2, "only fields with a length"
        size, at = varint(data, at)
        yield key >> 3, data[at : at + size]
        at += size


def feature(data):
    ((kind, content),) = list(fields(data))
    values = [value for _, value in fields(content)]
    if kind == 1:
        return values
    if kind == 2:
        return [number for value in values for (number,) in struct.iter_unpack("<f", value)]
    numbers, packed, at = [], b"".join(values), 0
    while at < len(packed):
        number, at = varint(packed, at)
        numbers.append(number)
    return numbers


def example(payload):
    out = {}
    for _, entry in fields(next(content for number, content in fields(payload) if number == 1)):
        parts = dict(fields(entry))
        out[parts[1].decode()] = feature(parts[2])
    return out


def png(data):
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, packed = 8, b""
    while at < len(data):
        (size,), kind = struct.unpack_from(">I", data, at), data[at + 4 : at + 8]
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack_from(">IIBB", data, at + 8)
            assert (depth, color) == (8, 2)
        if kind == b"IDAT":
            packed += data[at + 8 : at + 8 + size]
        at += size + 12
    raw, stride = zlib.decompress(packed), 3 * width
    rows, before = [], bytearray(stride)
    for y in range(height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1 : (y + 1) * (stride + 1)])
        for x in range(stride):
            left = row[x - 3] if x >= 3 else 0
            up, corner = before[x], before[x - 3] if x >= 3 else 0
            if kind == 1:
                add = left
            elif kind == 2:
                add = up
            elif kind == 3:
                add = (left + up) // 2
            elif kind == 4:
                guess = left + up - corner
                add = min((left, up, corner), key=lambda one: abs(guess - one))
            else:
                add = 0
            row[x] = (row[x] + add) & 0xFF
        rows.append(bytes(row))
        before = row
    return height, width, b"".join(rows)


def leaves(node, path=""):
    kind = node["pythonClassName"].split(".")[-1]
    if kind == "FeaturesDict":
        for name, child in node["featuresDict"]["features"].items():
            yield from leaves(child, f"{path}/{name}" if path else name)
    elif kind == "Dataset":
        yield from leaves(node["sequence"]["feature"], path)
    else:
        yield path, kind, node


folder = pathlib.Path(sys.argv[1])
info = json.loads((folder / "dataset_info.json").read_text())
wanted = list(leaves(json.loads((folder / "features.json").read_text())))
(split,) = info["splits"]
lengths = [int(length) for length in split["shardLengths"]]
bytes_read, episodes = 0, []
for shard, length in enumerate(lengths):
    path = folder / f"{info['name']}-{split['name']}.{info['fileFormat']}-{shard:05}-of-{len(lengths):05}"
    payloads = list(records(path))
    assert len(payloads) == length, f"{path}: {len(payloads)} records"
    for payload in payloads:
        bytes_read += len(payload)
        read = example(payload)
        assert set(read) == {path for path, _, _ in wanted}
        steps = len(read["steps/is_first"])
        for path, kind, node in wanted:
            size = 1
            for side in node.get("tensor", {}).get("shape", {}).get("dimensions", []):
                size *= int(side)
            count = steps if path.startswith("steps/") else 1
            assert len(read[path]) == count * size, f"{path}: {len(read[path])} values"
            if kind == "Image":
                pictures = [png(data) for data in read[path]]
                sides = [int(side) for side in node["image"]["shape"]["dimensions"]]
                assert all([height, width, 3] == sides for height, width, _ in pictures)
                read[path] = [hashlib.sha256(rgb).hexdigest() for _, _, rgb in pictures]
            elif kind == "Text":
                read[path] = [text.decode() for text in read[path]]
        episodes.append(read)
assert bytes_read == int(split["numBytes"])
assert sum(1 for _ in folder.iterdir()) == len(lengths) + 2
json.dump({"info": info, "episodes": episodes}, sys.stdout)
