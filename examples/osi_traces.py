#!/usr/bin/env python3
"""Writes a small trace of ASAM OSI GroundTruth, for `ttfusion run SCENARIO --truth TRACE`. It is an example to change.

    examples/osi_traces.py cut_in out/cut_in.osi

lane_change  A car drives away from standing sensors and changes lanes.
cut_in       A car cuts in before the vehicle with the sensors, and brakes.
queue        Three cars come to a stop one behind the other. One of them is towed away, and a fourth one comes.

It needs no package: the bytes are written by hand. A field of a message is its number and type in one byte, then its value.
"""
import math
import struct
import sys

STEP_S = 0.02
CAR = {"length": 4.39, "width": 1.79, "rear": 1.4}  # rear: from the rear axle to the middle of the box [m]


def varint(value: int) -> bytes:
    value &= 2**64 - 1
    low = b""
    while value > 0x7F:
        low += bytes([value & 0x7F | 0x80])
        value >>= 7
    return low + bytes([value])


def whole(field: int, value: int) -> bytes:
    return varint(field << 3) + varint(value)


def message(field: int, content: bytes) -> bytes:
    return varint(field << 3 | 2) + varint(len(content)) + content


def numbers(field: int, *values: float) -> bytes:
    """A message of doubles: Vector3d, Dimension3d, Orientation3d."""
    return message(field, b"".join(struct.pack("<Bd", n << 3 | 1, value) for n, value in enumerate(values, 1)))


def moving_object(identity: int, state: dict[str, float]) -> bytes:
    """Its position is that of the middle of its box."""
    c, s, v, a = math.cos(state["heading"]), math.sin(state["heading"]), state["speed"], state["acceleration"]
    base = numbers(1, CAR["length"], CAR["width"], 1.5)
    base += numbers(2, state["x"] + CAR["rear"] * c, state["y"] + CAR["rear"] * s, 0.75)
    base += numbers(3, 0.0, 0.0, state["heading"]) + numbers(4, v * c, v * s, 0.0) + numbers(5, a * c, a * s, 0.0)
    vehicle = message(5, numbers(4, -CAR["rear"], 0.0, 0.0)) + message(6, whole(1, 4))  # bbcenter_to_rear, TYPE_CAR
    return message(5, message(1, whole(1, identity)) + message(2, base) + whole(3, 2) + vehicle)  # TYPE_VEHICLE


def ground_truth(at_s: float, host: int | None, objects: dict[int, dict[str, float]]) -> bytes:
    ns = round(at_s * 1e9)
    truth = message(1, whole(1, 3) + whole(2, 8) + whole(3, 0))
    truth += message(2, whole(1, ns // 10**9) + whole(2, ns % 10**9))
    if host is not None:
        truth += message(3, whole(1, host))
    return truth + b"".join(moving_object(identity, state) for identity, state in objects.items())


def drive(duration_s: float, start: dict[str, float], speed, lateral) -> list[dict[str, float]]:
    """Returns the states every STEP_S. `speed` along the way and `lateral` velocity, of time, in m/s."""
    fine, x, y, states = STEP_S / 20, start["x"], start["y"], []
    for step in range(round(duration_s / fine) + 1):
        t, v = step * fine, speed(step * fine)
        heading = math.asin(lateral(t) / v) if v > 0 else 0.0
        if step % 20 == 0:
            acceleration = (speed(t + fine) - speed(max(0.0, t - fine))) / (2 * fine if t > 0 else fine)
            states.append({"x": x, "y": y, "heading": heading, "speed": v, "acceleration": acceleration})
        x, y = x + fine * math.cos(heading) * v, y + fine * lateral(t + fine / 2)
    return states


def lane_change(begin_s: float, takes_s: float, width_m: float):
    """The lateral velocity of a change along half a cosine."""
    peak = width_m * math.pi / (2 * takes_s)
    return lambda t: peak * math.sin(math.pi * (t - begin_s) / takes_s) if begin_s < t < begin_s + takes_s else 0.0


def braking(speed_mps: float, begin_s: float, deceleration_mps2: float):
    return lambda t: max(0.0, speed_mps - deceleration_mps2 * max(0.0, t - begin_s))


def straight(_: float) -> float:
    return 0.0


def traces() -> dict[str, tuple[int | None, dict[int, tuple[float, list[dict[str, float]]]]]]:
    """Returns for each trace its host and its objects: the instant at which each comes, and its states from there on."""
    cutting_in = drive(6.4, {"x": 80, "y": 1.535}, braking(15, 4.01, 5.2), lane_change(2.0, 3.0, -3.0))
    host = drive(6.4, {"x": 50, "y": -1.465}, braking(20, 3.0, 5.0), straight)
    queue = {n: (0.0, drive(8.0, {"x": 8 + 9 * n, "y": 0}, braking(6, 1 + 0.5 * (3 - n), 2.5), straight)) for n in (1, 2, 3)}
    queue[3] = (0.0, queue[3][1][:301])
    queue[4] = (3.0, drive(5.0, {"x": 5, "y": 3.5}, braking(6, 1.0, 2.0), straight))
    changing = drive(8.0, {"x": 15, "y": 0}, lambda t: 5.0, lane_change(2.0, 4.0, 3.5))
    return {"lane_change": (None, {42: (0.0, changing)}), "cut_in": (1, {1: (0.0, host), 2: (0.0, cutting_in)}),
            "queue": (None, queue)}


def main() -> int:
    known = traces()
    if len(sys.argv) != 3 or sys.argv[1] not in known:
        print(__doc__, file=sys.stderr)
        return 2
    host, objects = known[sys.argv[1]]
    last = max(round(begin / STEP_S) + len(states) for begin, states in objects.values())
    try:
        file = open(sys.argv[2], "wb")
    except OSError as error:
        print(f"error: {sys.argv[2]}: cannot be written: {error.strerror}", file=sys.stderr)
        return 2
    with file:
        for k in range(last):
            now = {}
            for identity, (begin, states) in objects.items():
                at = k - round(begin / STEP_S)
                if 0 <= at < len(states):
                    now[identity] = states[at]
            truth = ground_truth(k * STEP_S, host, now)
            file.write(struct.pack("<I", len(truth)) + truth)
    return 0


if __name__ == "__main__":
    sys.exit(main())
