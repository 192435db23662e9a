#!/usr/bin/env python3
"""Draws errors and ages of a drive from its tables. It is an example to change.

    ttfusion export out/paper_scenario1/tt.mcap --format tables -o out/tables
    examples/table_figure.py out/tables out/errors.pdf

The tables may be those of --format sqlite in one file, too: out/tables.sqlite.

It draws with Matplotlib (Debian: python3-matplotlib). The name of the figure
ends with its format: .pdf, .svg or .png. Exit code 1: there is no Matplotlib. Exit code 2: a table cannot be read.
"""
import contextlib
import csv
import math
import pathlib
import sqlite3
import sys


def rows(tables: pathlib.Path, name: str) -> list:
    """Returns a table's rows; the name of a column gives a row's field."""
    if not tables.is_file():
        with open(tables / f"{name}.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))
    with contextlib.closing(sqlite3.connect(f"{tables.absolute().as_uri()}?mode=ro", uri=True)) as database:
        database.row_factory = sqlite3.Row
        return database.execute(f"SELECT * FROM {name} ORDER BY rowid").fetchall()


def number(field: str | float | None) -> float:
    """An empty field is an absent value."""
    return math.nan if field in ("", None) else float(field)


def position_errors(tables: pathlib.Path) -> dict[str, list[tuple[float, float]]]:
    """Returns for each object: time [s] and distance [m] from the truth, for each use of an image."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in rows(tables, "errors"):
        distance_m = math.hypot(number(row["error_x_m"]), number(row["error_y_m"]))
        found.setdefault(f"object {row['object']}", []).append((float(row["time_s"]), distance_m))
    return found


def ages(tables: pathlib.Path) -> dict[str, list[tuple[float, float]]]:
    """Returns for each sensor: time [s], and the age [ms] of its newest measurement in the used image."""
    found: dict[str, list[tuple[float, float]]] = {}
    for row in rows(tables, "ages"):
        found.setdefault(row["sensor"], []).append((float(row["time_s"]), number(row["age_ms"])))
    return found


def draw(tables: pathlib.Path, picture: str) -> None:
    errors, of_sensors = position_errors(tables), ages(tables)
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
    except (KeyError, IndexError, ValueError, sqlite3.Error) as error:
        print(f"error: {sys.argv[1]}: not the tables of a drive: {error}", file=sys.stderr)
        sys.exit(2)
