#!/usr/bin/env python3
"""Reads a Perfetto trace without our format description or protobuf's code, as its readers do: by the field numbers of
Perfetto's own protos/perfetto/trace (trace_packet, track_event/track_event, track_descriptor, debug_annotation).

    perfetto_reader.py FILE      prints its contents; exit 1 and a line for every error in it
"""

import struct
import sys

VARINT, FIXED64, BYTES, FIXED32 = 0, 1, 2, 5
BEGIN, END, INSTANT, COUNTER = 1, 2, 3, 4


def varint(data: bytes, at: int) -> tuple[int, int]:
    value = shift = 0
    while True:
        byte = data[at]
        value |= (byte & 0x7F) << shift
        at, shift = at + 1, shift + 7
        if byte < 0x80:
            return value, at


def fields(data: bytes) -> dict[int, list]:
    """By number, in order: (wire type, value)."""
    found: dict[int, list] = {}
    at = 0
    while at < len(data):
        key, at = varint(data, at)
        kind = key & 7
        if kind == VARINT:
            value, at = varint(data, at)
        elif kind == BYTES:
            size, at = varint(data, at)
            value, at = data[at:at + size], at + size
            assert len(value) == size, "cut off"
        else:
            size = {FIXED64: 8, FIXED32: 4}[kind]
            value, at = data[at:at + size], at + size
        found.setdefault(key >> 3, []).append((kind, value))
    return found


def one(of: dict[int, list], number: int, kind: int, absent=None):
    if number not in of:
        return absent
    assert len(of[number]) == 1 and of[number][0][0] == kind, f"field {number} is {of[number]}"
    return of[number][0][1]


def main(path: str) -> int:
    problems, tracks, open_slices, flows = [], {}, {}, {}
    counts = {BEGIN: 0, END: 0, INSTANT: 0, COUNTER: 0}
    now, first = 0, True
    trace = fields(open(path, "rb").read())
    if set(trace) - {1}:
        problems.append(f"a trace has packets alone, not {sorted(trace)}")
    for _, bytes_ in trace.get(1, []):
        packet = fields(bytes_)
        if one(packet, 10, VARINT) is None:
            problems.append("a packet of no sequence")
        if first and one(packet, 13, VARINT, 0) & 1 == 0:
            problems.append("the sequence does not say that it begins")
        first = False
        if (described := one(packet, 60, BYTES)) is not None:
            track = fields(described)
            uuid, name = one(track, 1, VARINT, 0), one(track, 2, BYTES, b"").decode()
            parent = one(track, 5, VARINT)
            if (process := one(track, 3, BYTES)) is not None:
                name = one(fields(process), 6, BYTES, b"").decode()
            elif parent not in tracks:
                problems.append(f"{name} is of no group")
            if uuid == 0 or uuid in tracks or not name:
                problems.append(f"track {uuid} {name!r}: no id of its own, or no name")
            tracks[uuid] = (name, 8 in track)
        if (bytes_of_event := one(packet, 11, BYTES)) is None:
            continue
        event, at = fields(bytes_of_event), one(packet, 8, VARINT, 0)
        kind, uuid = one(event, 9, VARINT, 0), one(event, 11, VARINT, 0)
        if at < now:
            problems.append(f"{at} comes after {now}")
        now = max(now, at)
        if kind not in counts or uuid not in tracks:
            problems.append(f"an event of type {kind} on track {uuid}")
            continue
        counts[kind] += 1
        if tracks[uuid][1] != (kind == COUNTER):
            problems.append(f"{tracks[uuid][0]} counts and does not")
        if kind == COUNTER:
            struct.unpack("<d", one(event, 44, FIXED64))
        if kind == BEGIN:
            open_slices[uuid] = open_slices.get(uuid, 0) + 1
        if kind == END:
            open_slices[uuid] = open_slices.get(uuid, 0) - 1
            if open_slices[uuid] < 0:
                problems.append(f"{tracks[uuid][0]}: what never began ends")
        if kind in (BEGIN, INSTANT) and not one(event, 23, BYTES, b"").decode():
            problems.append(f"{tracks[uuid][0]}: a slice without a name at {at}")
        for _, note in event.get(4, []):
            inside = fields(note)
            if not one(inside, 10, BYTES, b"").decode() or len({4, 6} & set(inside)) != 1:
                problems.append(f"a note without name or value: {inside}")
        for number in (47, 48):
            for wire, flow in event.get(number, []):
                if wire != FIXED64:
                    problems.append(f"a flow's id of wire type {wire}")
                steps = flows.setdefault(flow, [])
                if steps and steps[-1] == 48:
                    problems.append("a flow goes on after its end")
                steps.append(number)
    problems += [f"{tracks[uuid][0]}: a slice never ends" for uuid, depth in open_slices.items() if depth > 0]
    problems += [f"a flow of {steps}" for steps in flows.values() if len(steps) < 2 or steps[-1] != 48]
    for problem in problems[:20]:
        print(problem)
    print(f"{len(tracks)} tracks, {counts[BEGIN]} slices, {counts[INSTANT]} instants, {counts[COUNTER]} counts, "
          f"{len(flows)} flows")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
