#!/usr/bin/env python3
"""Reads an exported OSI trace by the schemas in its MCAP file, with Python's Protocol Buffers (Debian: python3-protobuf).

    osi_reader.py TRACE.mcap FOLDER

FOLDER has the same messages as two .osi files. Exit code 77: there is no such package.
"""
import pathlib
import struct
import sys

try:
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory
except ImportError:
    sys.exit(77)

MAGIC, SCHEMA = b"\x89MCAP0\r\n", 3


def text(content: bytes, at: int) -> tuple[bytes, int]:
    length = struct.unpack_from("<I", content, at)[0]
    return content[at + 4 : at + 4 + length], at + 4 + length


def schemas(mcap: bytes) -> dict[str, bytes]:
    """Returns the schemas that stand outside of chunks, by name."""
    found, at = {}, len(MAGIC)
    while at + 9 <= len(mcap):
        opcode, length = struct.unpack_from("<BQ", mcap, at)
        content = mcap[at + 9 : at + 9 + length]
        if opcode == SCHEMA:
            name, behind = text(content, 2)
            encoding, behind = text(content, behind)
            assert encoding == b"protobuf", encoding
            found[name.decode()] = text(content, behind)[0]
        at += 9 + length
    return found


def messages(file: pathlib.Path, schema: bytes, name: str) -> list:
    files = descriptor_pb2.FileDescriptorSet.FromString(schema)
    pool = descriptor_pool.DescriptorPool()
    for one in files.file:
        pool.Add(one)
    kind = message_factory.MessageFactory(pool).GetPrototype(pool.FindMessageTypeByName(name))
    bytes_, at, read = file.read_bytes(), 0, []
    while at < len(bytes_):
        length = struct.unpack_from("<I", bytes_, at)[0]
        read.append(kind.FromString(bytes_[at + 4 : at + 4 + length]))
        at += 4 + length
    return read


def main() -> int:
    known = schemas(pathlib.Path(sys.argv[1]).read_bytes())
    folder = pathlib.Path(sys.argv[2])
    truths = messages(next(folder.glob("*_gt_*.osi")), known["osi3.GroundTruth"], "osi3.GroundTruth")
    images = messages(next(folder.glob("*_sd_*.osi")), known["osi3.SensorData"], "osi3.SensorData")
    seconds = [t.timestamp.seconds + 1e-9 * t.timestamp.nanos for t in truths]
    assert seconds == sorted(seconds), "stamps do not ascend"
    by_id = {o.id.value: o for o in truths[-1].moving_object}
    assert by_id and all(o.base.dimension.length > 0 for o in by_id.values()), truths[-1]
    tracks = [track for image in images for track in image.moving_object]
    assert tracks and all(t.base_rmse.position.x > 0 and t.header.HasField("tracking_id") for t in tracks), images[-1]
    # At the end, some track is where an object is.
    nearest = min(abs(t.base.position.x - o.base.position.x) + abs(t.base.position.y - o.base.position.y)
                  for t in images[-1].moving_object for o in by_id.values())
    assert nearest < 1.0, nearest
    return 0


if __name__ == "__main__":
    sys.exit(main())
