#!/usr/bin/env python3
"""Draws errors and ages of a drive from its tables. It is an example to change.

    ttfusion export out/paper_scenario1/tt.mcap --format tables -o out/tables
    examples/table_figure.py out/tables out/errors.pdf

It draws with Matplotlib (Debian: python3-matplotlib). The name of the figure
ends with its format: .pdf, .svg or .png. Exit code 1: there is no Matplotlib. Exit code 2: a table cannot be read.
"""
import csv
import math
import pathlib
import sys


def rows(folder: pathlib.Path, table: str) -> list[dict[str, str]]:
    with open(folder / f"{table}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def number(text: str) -> float:
    """An empty field is an absent value."""
    return float(text) if text else math.nan


def position_errors(folder: pathlib.Path) -> dict[str, list[tuple[float, float]]]:
    """Returns for each object: time [s] and distance [m] from the truth, for each use of an image."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in rows(folder, "errors"):
        distance_m = math.hypot(number(row["error_x_m"]), number(row["error_y_m"]))
        found.setdefault(f"object {row['object']}", []).append((float(row["time_s"]), distance_m))
    return found


def ages(folder: pathlib.Path) -> dict[str, list[tuple[float, float]]]:
    """Returns for each sensor: time [s], and the age [ms] of its newest measurement in the used image."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in rows(folder, "ages"):
        found.setdefault(row["sensor"], []).append((float(row["time_s"]), number(row["age_ms"])))
    return found


def draw(folder: pathlib.Path, picture: str) -> None:
    errors, of_sensors = position_errors(folder), ages(folder)
    import matplotlib
    matplotlib.use("Agg")  # writes files, and needs no screen
    import matplotlib.pyplot as plt

    figure, (above, below) = plt.subplots(2, 1, sharex=True, figsize=(6.3, 4.5), constrained_layout=True)
    for name, points in errors.items():
        above.plot(*zip(*points), label=name)
    above.set_ylabel("position error [m]")
    if 1 < len(errors) <= 10:
        above.legend()
    for name, points in of_sensors.items():
        below.plot(*zip(*points), ".", label=name)
    below.set_xlabel("time [s]")
    below.set_ylabel("age when used [ms]")
    if of_sensors:
        below.legend()
    figure.savefig(picture)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        sys.exit(2)
    try:
        draw(pathlib.Path(sys.argv[1]), sys.argv[2])
    except ImportError as error:
        sys.exit(f"error: {error.name} is missing: install Debian's python3-matplotlib")
    except OSError as error:
        print(f"error: {error.filename}: {error.strerror}", file=sys.stderr)
        sys.exit(2)
    except (KeyError, ValueError) as error:
        print(f"error: {sys.argv[1]}: not the tables of a drive: {error}", file=sys.stderr)
        sys.exit(2)
