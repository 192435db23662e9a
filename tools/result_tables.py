"""The tables of docs/results: a page's directives make them from the answer of an experiment.

A directive stands as a comment above its table:

    <!-- table: KIND MEASURES of PARADIGMS; KEY: VALUE; ... -->

    values       mean and interval of one measure, a column a paradigm; without `of`, of all
    means        the same without intervals, a column a paradigm or a measure; counts and ages
    differences  the baseline's mean, then the paired differences of the others from it
    percent      the paired difference of one paradigm, in per cent of the baseline's mean, with Fieller's interval
    changes      of an experiment that compares an axis: each paradigm's change from the axis's baseline, likewise
    interactions the measure's interactions: the change of each of the two paradigms, and of one against the other; of several,
                 a first column names the change

    rows: AXES       these name the rows (default: all axes that `columns` and `where` do not name)
    columns: AXIS    its values name the columns, of one paradigm
    where: A=V, ...  points with these values only
    names: X=Y, ...  the page says Y where the experiment says X; `<!-- names: X=Y, ... -->` says it for a page's tables
    crossing: yes    percent: a last column, where the sign changes along `columns`
    given: X=V V .., a column X before the others, of figures that are not the answer's, a value a row; to compare with
    seeds: N, M of P a column behind the others for each of these seeds: the figure of paradigm P (default: the last one) by the same
                 command with `--seed N`. `N without R` is the mean without replication R, for `means` and `percent`

A change in per cent is the answer's own (experiments/results/ratio.h): its interval contains the spreads of both means.
Where the baseline's mean is not certainly above 0, the change has no interval, and the table says so.

Differences that stay certain among all of their measure, by Holm's method, are bold. A line above the table counts them.
"""
import copy
import math
import re

NAMES = re.compile(r"<!-- names: ([^>]*?) -->")
DIRECTIVE = re.compile(r"<!-- table: ([^>]*?) -->\n*(?:\*[^*\n]+\*\n+)?((?:\|[^\n]*\n)*)")
SEED = re.compile(r"^(\d+)(?: without (\d+))?$")
SMALLEST = 1e-9  # below, a figure is rounding
MOST_PLACES = 6
KINDS = ("values", "means", "differences", "percent", "changes", "interactions")


class Wrong(Exception):
    """A directive that cannot be followed."""


class Directive:
    def __init__(self, text, names=None):
        parts = [part.strip() for part in " ".join(text.split()).split(";")]
        words, _, paradigms = parts[0].partition(" of ")
        self.text, (self.kind, *self.measures) = text, words.split()
        self.paradigms = paradigms.split()
        keys = dict(part.split(": ", 1) for part in parts[1:])
        listed = {key: [item.strip() for item in value.split(",")] for key, value in keys.items()}
        self.rows = listed.get("rows")
        self.columns = keys.get("columns")
        self.where = dict(item.split("=", 1) for item in listed.get("where", []))
        self.names = {**(names or {}), **dict(item.split("=", 1) for item in listed.get("names", []))}
        self.crossing = "crossing" in keys
        self.given = {name: values.split() for name, values in (item.split("=", 1) for item in listed.get("given", []))}
        seeds, _, of_seeds = keys.get("seeds", "").partition(" of ")
        self.of_seeds = of_seeds or (self.paradigms[-1] if self.paradigms else "")
        self.seeds = [seed.strip() for seed in seeds.split(",") if seed.strip()]
        unknown = set(keys) - {"rows", "columns", "where", "names", "crossing", "given", "seeds"}
        if self.kind not in KINDS or not self.measures or unknown:
            raise Wrong(f"table: {text}: must be one of {', '.join(KINDS)}, a measure, and known keys")
        if self.seeds and (self.kind in ("changes", "interactions") or len(self.measures) > 1 or self.columns
                           or not self.of_seeds or not all(SEED.match(seed) for seed in self.seeds)):
            raise Wrong(f"table: {text}: seeds must be as `2` or `2 without 8`, of one paradigm and measure, without `columns`")

    def of_one(self, paradigm):
        """The table's column of one paradigm alone."""
        one = copy.copy(self)
        one.paradigms, one.given, one.seeds = [paradigm], {}, []
        return one

    def numbers(self):
        """Each further column's seed, and the replication that it leaves out or None."""
        return [SEED.match(seed).groups() for seed in self.seeds]

    def name(self, word):
        return self.names.get(word, word.replace("_", " "))


class Cell:
    """A figure of a table: of a paradigm at a point, and the figure's half width; None where it has none."""

    def __init__(self, point, paradigm, measure, text, half_width=None):
        self.point, self.paradigm, self.measure, self.text, self.half_width = point, paradigm, measure, text, half_width
        self.seed = None  # another one than the page's


def decimals(value, half_width, digits=2):
    scale = half_width if half_width and half_width > 0 else abs(value)
    wanted = digits if half_width else 3
    return max(0, wanted - 1 - math.floor(math.log10(scale))) if scale > 0 else 0


def interval(mean, half_width, sign=""):
    if not half_width:
        return brief(mean, sign)
    places = decimals(mean, half_width)
    return f"{mean:{sign}.{places}f} ± {half_width:.{places}f}"


def brief(value, sign=""):
    """Writes a figure without an interval. It is a dash if no drive has one."""
    if value is None:
        return "-"
    return f"{value:{sign}.{decimals(value, None)}f}" if abs(value) >= SMALLEST else "0"


def change(estimate):
    """A change in per cent with its interval's ends, or else in the measure's unit."""
    if "percent" not in estimate:
        return interval(estimate["mean"], estimate["half_width"], "+")
    mean, low, high = (estimate["percent"][key] for key in ("mean", "low", "high"))
    if low is None:
        return f"{brief(mean, '+')} (no interval)"
    places = max(0, -math.floor(math.log10(0.5 * (high - low)))) if high > low else 1
    nearest = max(low, 0) or min(high, 0)
    while places < MOST_PLACES and nearest and not round(nearest, places):  # an interval that excludes 0 shows it
        places += 1
    text = f"{mean:+.{places}f} ({low:+.{places}f} to {high:+.{places}f})"
    return re.sub(r"[-+](0(?:\.0+)?)(?=[ )])", r"\1", text)  # 0 has no sign


def bold(text, certain):
    return f"**{text}**" if certain else text


def crossing(densities, percents):
    """The value along the columns at which the sign changes first, on a logarithmic scale."""
    for (x0, y0), (x1, y1) in zip(zip(densities, percents), zip(densities[1:], percents[1:])):
        if y0 * y1 < 0:
            return f"{math.exp(math.log(x0) + math.log(x1 / x0) * y0 / (y0 - y1)):.2g}"
    return "none: always " + ("less" if percents[0] < 0 else "more")


def certain_of(answer, measure):
    """The (point, paradigm) whose differences stay certain together, by Holm's method."""
    level = 1 - answer["confidence"]
    found = sorted((cells[measure]["difference"]["p"], point["point"], paradigm) for point in answer["points"]
                   for paradigm, cells in point["paradigms"].items()
                   if cells[measure].get("difference", {}).get("p") is not None)
    certain = set()
    for k, (p, point, paradigm) in enumerate(found):
        if p > level / (len(found) - k):
            break
        certain.add((point, paradigm))
    return certain


class Table:
    """A directive's table of an answer (answer.json)."""

    def __init__(self, directive, answer):
        self.directive, self.answer = directive, answer
        self.baseline = answer["baseline"]
        points = [p for p in answer["points"] if all(p["axes"].get(k) == v for k, v in directive.where.items())]
        if not points:
            raise Wrong(f"table: {directive.text}: no point is like this")
        taken = {directive.columns, *directive.where}
        self.rows = directive.rows or [axis for axis in points[0]["axes"] if axis not in taken]
        self.grouped = {}
        for point in points:
            key = tuple(point["axes"][axis] for axis in self.rows)
            self.grouped.setdefault(key, []).append(point)
        everyone = list(points[0]["paradigms"])
        self.paradigms = directive.paradigms or everyone
        strangers = [p for p in self.paradigms if p not in everyone]
        if strangers:
            raise Wrong(f"table: {directive.text}: {strangers[0]} is no paradigm (there are: {', '.join(everyone)})")
        self.certain = {m: certain_of(answer, m) for m in directive.measures}
        self.header, self.lines = self.with_seeds(*self.with_given(*self.laid_out()))

    def estimate(self, point, paradigm, measure):
        return point["paradigms"][paradigm][measure]

    def value(self, point, paradigm, measure):
        e = self.estimate(point, paradigm, measure)
        return Cell(point, paradigm, measure, interval(e["mean"], e["half_width"]), e["half_width"])

    def mean(self, point, paradigm, measure):
        e = self.estimate(point, paradigm, measure)
        return Cell(point, paradigm, measure, brief(e["mean"]))

    def difference(self, point, paradigm, measure):
        if paradigm == self.baseline:
            return self.value(point, paradigm, measure)
        d = self.estimate(point, paradigm, measure)["difference"]
        text = interval(d["mean"], d["half_width"], "+") if d["half_width"] else brief(d["mean"], "+")
        return Cell(point, paradigm, measure, bold(text, (point["point"], paradigm) in self.certain[measure]), d["half_width"])

    def percent(self, point, paradigm, measure):
        d = self.estimate(point, paradigm, measure)["difference"]
        if self.estimate(point, self.baseline, measure)["mean"] is None:
            return Cell(point, paradigm, measure, "-")
        if "percent" not in d:
            raise Wrong(f"table: {self.directive.text}: the kept answer has no change of {measure} in per cent")
        return Cell(point, paradigm, measure, bold(change(d), (point["point"], paradigm) in self.certain[measure]), d["half_width"])

    def changes(self):
        d, measure = self.directive, self.directive.measures[0]
        lines = []
        for point in (p for points in self.grouped.values() for p in points):
            found = [(p, self.estimate(point, p, measure).get("difference")) for p in self.paradigms]
            if all(e is not None for _, e in found):
                lines.append(([d.name(point["axes"][axis]) for axis in self.rows],
                              [Cell(point, p, None, bold(change(e), (point["point"], p) in self.certain[measure]))
                               for p, e in found]))
        return [d.name(axis) for axis in self.rows] + [d.name(p) for p in self.paradigms], lines

    def interactions(self):
        d, header, lines = self.directive, [], []
        asked = [one for one in self.answer.get("interactions", []) if one["measure"] == d.measures[0]]
        for one in asked:
            first, second = d.name(one["lowers"]), d.name(one["more_than"])
            changed = [f"{d.name(one['from'])} to {d.name(one['to'])}"] if len(asked) > 1 else []
            header = [*(["change"] if changed else []), *map(d.name, one["points"][0]["axes"]), first, second,
                      f"{first} against {second}"]
            for point in one["points"]:
                texts = [change(point["first"]), change(point["second"]),
                         bold(change(point["interaction"]), point["interaction"]["stays_certain"])]
                lines.append(([*changed, *(d.name(label) for label in point["axes"].values())],
                              [Cell(None, None, None, text) for text in texts]))
        if not lines:
            raise Wrong(f"table: {d.text}: the experiment has no such interaction")
        return header, lines

    def with_given(self, header, lines):
        given = self.directive.given
        for name, values in given.items():
            if len(values) != len(lines):
                raise Wrong(f"table: {self.directive.text}: {name} has {len(values)} values for {len(lines)} rows")
        header = [*header[:len(self.rows)], *given, *header[len(self.rows):]]
        return header, [([*named, *(values[i] for values in given.values())], cells)
                        for i, (named, cells) in enumerate(lines)]

    def with_seeds(self, header, lines):
        d = self.directive
        for seed, (number, without) in zip(d.seeds, d.numbers()):
            answer = self.answer.get("seeds", {}).get(number)
            if answer is not None and without is not None:
                answer = {**answer, "points": answer["without"].get(without)}
            if not answer or not answer["points"]:
                raise Wrong(f"table: {d.text}: no answer of seed {seed} is kept")
            cells = [cells[-1] for _, cells in Table(d.of_one(d.of_seeds), answer).lines]
            for cell in cells:
                # The kept paradigms are no family. Without a replication there are means alone.
                cell.seed, cell.text = number, cell.text.replace("**", "").removesuffix(" (no interval)" if without else "")
            header = [*header, d.name(f"seed {seed}")]
            lines = [(named, [*before, cell]) for (named, before), cell in zip(lines, cells)]
        return header, lines

    def laid_out(self):
        d = self.directive
        if d.kind in ("changes", "interactions"):
            return self.changes() if d.kind == "changes" else self.interactions()
        make = {"values": self.value, "means": self.mean, "differences": self.difference, "percent": self.percent}[d.kind]
        header, lines = [d.name(axis) for axis in self.rows], []
        first = next(iter(self.grouped.values()))
        by_measure = d.kind == "means" and len(d.measures) > 1
        if d.columns:
            header += [d.name(p["axes"][d.columns]) for p in first]
        elif by_measure:
            header = [*header, *(["paradigm"] if len(self.paradigms) > 1 else []), *map(d.name, d.measures)]
        elif d.kind == "differences":
            header += [d.name(self.baseline), *(f"{d.name(p)} - {d.name(self.baseline)}" for p in self.paradigms
                                                if p != self.baseline)]
        else:
            header += [d.name(p) for p in self.paradigms]
        if d.crossing:
            header.append("crossing")
        for key, points in self.grouped.items():
            named = [d.name(k) for k in key]
            if d.columns:
                cells = [make(p, self.paradigms[0], d.measures[0]) for p in points]
                lines.append((named, cells))
                if d.crossing:
                    ratios = [self.estimate(p, self.paradigms[0], d.measures[0])["difference"]["mean"] for p in points]
                    cells.append(Cell(points[0], self.paradigms[0], None,
                                      crossing([float(p["axes"][d.columns]) for p in points], ratios)))
                continue
            if len(points) > 1:
                raise Wrong(f"table: {d.text}: several points in one row")
            if by_measure:
                for paradigm in self.paradigms:
                    label = [d.name(paradigm)] if len(self.paradigms) > 1 else []
                    lines.append((named + label, [make(points[0], paradigm, m) for m in d.measures]))
                continue
            order = self.paradigms
            if d.kind == "differences":
                order = [self.baseline, *(p for p in self.paradigms if p != self.baseline)]
            lines.append((named, [make(points[0], p, d.measures[0]) for p in order]))
        return header, lines

    def caption(self):
        if self.directive.kind not in ("differences", "percent", "changes", "interactions"):
            return ""
        measure = self.directive.measures[0]
        if self.directive.kind == "interactions":
            points = [point for one in self.answer["interactions"] if one["measure"] == measure for point in one["points"]]
            by_ratio = all("percent" in point["interaction"] for point in points)
            return (f"*`{measure}`{' [%]' if by_ratio else ''}, {max(p['interaction']['count'] for p in points):,} replications, "
                    f"seed {self.answer['seed']}: {sum(p['interaction']['stays_certain'] for p in points)} of {len(points)} "
                    f"interactions, in bold, stay certain together.*\n\n")
        counts = [cells[measure]["count"] for point in self.answer["points"] for cells in point["paradigms"].values()]
        comparisons = sum(cells[measure].get("difference", {}).get("p") is not None
                          for point in self.answer["points"] for cells in point["paradigms"].values())
        unit = self.answer["measures"][measure]["unit"].replace("^2", "²")
        share = (f"per cent of {self.directive.name(self.baseline)}'s" if self.directive.kind == "percent" else
                 "%" if self.directive.kind == "changes" else unit)
        many = f"{max(counts):,}" if min(counts) == max(counts) else f"{min(counts):,} to {max(counts):,}"
        return (f"*`{measure}`{f' [{share}]' if share else ''}, {many} replications, seed {self.answer['seed']}: "
                f"{len(self.certain[measure])} of {comparisons} comparisons, in bold, stay certain together.*\n\n")

    def text(self):
        rows = [self.header, ["---"] * len(self.header)]
        rows += [[*named, *(cell.text for cell in cells)] for named, cells in self.lines]
        return self.caption() + "".join("| " + " | ".join(row) + " |\n" for row in rows).replace("| --- ", "|---").replace("---|---", "---|---")

    def cells(self):
        return [cell for _, cells in self.lines for cell in cells]


def names_of(page):
    return {name: said for match in NAMES.finditer(page)
            for name, said in (item.strip().split("=", 1) for item in " ".join(match[1].split()).split(","))}


def tables_of(page):
    """The directives of a page's text, with the tables that stand below them."""
    names = names_of(page)
    return [(Directive(match[1], names), match[2]) for match in DIRECTIVE.finditer(page)]


def filled(page, answer):
    """The page's text with its tables made anew."""
    names = names_of(page)

    def made(match):
        return f"<!-- table: {match[1]} -->\n\n{Table(Directive(match[1], names), answer).text()}"
    return DIRECTIVE.sub(made, page)
