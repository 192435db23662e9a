#!/usr/bin/env python3
"""A sentence of a results' page follows from its tables: each figure of the page's answer is computed from them anew.

    sentences_test.py REPOSITORY      exit 1 and one line for every figure that does not follow

A directive stands behind a paragraph, and accounts for every figure in digits there:

    <!-- says: FIGURE = EXPRESSION; FIGURE = EXPRESSION; given: WORDS, WORDS; apart: WORDS, WORDS -->

    FIGURE      words of the paragraph with their figures: "13 % (4 to 21) less", "0.3 to 8 %", "44 times", "a third"
    EXPRESSION  gives these figures by the tables, in Python (below)
    given       figures of the conditions: a bound, a density, a seed
    apart       results that no table of the page has; these are not held

    t(N, ROW, COLUMN)            a cell of the page's N-th table. ROW has the row's first cells, separated by |; each may have *.
                                 COLUMN is a header, or several, separated by |; #3 is the third. Several cells are a list.
    of(PAGE, N, ROW, COLUMN)     a cell of another page of docs/results
    printed(PATTERN)             the figures that a regular expression finds in the page's code blocks
    change(PARADIGM, AXES, MEASURE), kept(PARADIGM, AXES, MEASURE)
                                 of the page's kept answer, at the point with these values of AXES, "density=4, period=80": the
                                 change from the baseline in per cent; the mean
    span(CELLS, ...)             the least and the largest; least(CELLS, ...), most(CELLS, ...): one of the two
    ratio(CELLS, BASES), share(CELLS, BASES), minus(CELLS, BASES), plus(CELLS, BASES)
                                 each over its base, in per cent of it, less it, and with it
    between(CELLS, LOW, HIGH), signed(CELLS)
                                 the cells from LOW to HIGH; those whose interval excludes 0
    ends(CELLS)                  both ends of each cell's interval; a cell without an interval is both of its ends
    half(CELL), squared(CELL)    the interval's half width; the square

A cell has a mean, and an interval if the table prints one: "13 ± 10" are mean and half width, "13 (4 to 21)" mean and ends.
"-29..-23" are two cells, the ends of an interval.
A figure holds if it is the expression's value to its last digit; the cells' own rounding is allowed for. A fraction in
words may be off by an eighth of itself.

README.md's answer, and short answer and range of docs/results.md, have directives, too. The other answers in docs/results.md take
their figures from the answers of their pages: each figure is there, too.
"""
import fnmatch
import json
import math
import pathlib
import re
import sys

SAYS = re.compile(r"<!-- says: (.*?) -->", re.DOTALL)
COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
NUMBER = re.compile(r"(?<![\w.,])[-+]?\d+(?:,\d{3})*(?:\.\d+)?(?![\w]*[A-Za-z_]\d)")
BLOCK = re.compile(r"^```.*?^```$|^    [^\n]*$", re.DOTALL | re.MULTILINE)
UNREAD = re.compile(r"`[^`]*`|\]\([^)]*\)|\*\*")   # code, links' targets and marks have no figures
ITEM = re.compile(r"^\d+\. ", re.MULTILINE)          # the number of a list's item is no figure, either
WORDS = {"none": 0, "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9,
         "ten": 10, "eleven": 11, "twelve": 12}
PARTS = {"half": 1 / 2, "third": 1 / 3, "quarter": 1 / 4, "fifth": 1 / 5, "sixth": 1 / 6, "seventh": 1 / 7, "eighth": 1 / 8,
         "tenth": 1 / 10}
FRACTION = re.compile(rf"\b(?:(an?|{'|'.join(WORDS)}) )?({'|'.join(PARTS)})s?\b", re.IGNORECASE)
OFF = 1 / 8    # share of a fraction in words that it may be off by


class Wrong(Exception):
    """A directive that cannot be followed."""


def digits(text):
    """The place of a figure's last digit: 0.01 for 2.50. Zeros at the end of a thousand and more are rounding."""
    whole, _, behind = text.lstrip("+-").replace(",", "").partition(".")
    if behind:
        return 10.0 ** -len(behind)
    return 10.0 ** min(len(whole) - len(whole.rstrip("0")), len(whole) - 2) if len(whole) > 3 else 1.0


class Figure:
    """A value with its rounding; a cell's has an interval, too, if it is printed."""

    def __init__(self, value, off=0.0, half=None, low=None, high=None):
        self.value, self.off, self.half, self.low, self.high = value, off, half, low, high

    def __neg__(self):
        return Figure(-self.value, self.off, self.half, None if self.high is None else -self.high,
                      None if self.low is None else -self.low)

    def __abs__(self):
        return -self if self.value < 0 else self

    def __add__(self, other):
        other = plain(other)
        return Figure(self.value + other.value, self.off + other.off)

    def __mul__(self, other):
        other = plain(other)
        return Figure(self.value * other.value, abs(self.value) * other.off + abs(other.value) * self.off)

    def __truediv__(self, other):
        other = plain(other)
        ratio = self.value / other.value
        return Figure(ratio, abs(ratio) * (self.off / max(abs(self.value), 1e-300) + other.off / abs(other.value)))

    def __sub__(self, other):
        return self + -plain(other)

    def __rsub__(self, other):
        return plain(other) - self

    def __radd__(self, other):
        return self + other

    def __rmul__(self, other):
        return self * other

    def __rtruediv__(self, other):
        return plain(other) / self

    def __lt__(self, other):
        return self.value < plain(other).value

    def __gt__(self, other):
        return self.value > plain(other).value


def plain(value):
    return value if isinstance(value, Figure) else Figure(float(value))


def number(text):
    return float(text.replace(",", ""))


def figures_of(cell):
    """The figures of a table's cell, most often one."""
    text = cell.replace("*", "").replace("−", "-").replace("..", " to ").strip()
    parts = NUMBER.findall(text)
    if not parts:
        return []
    off = 0.5 * digits(parts[0]) if "." in parts[0] else 0.5 * digits(parts[0]) * (len(parts) > 1 and ("±" in text or " to " in text))
    if "±" in text and len(parts) == 2:
        return [Figure(number(parts[0]), off, half=abs(number(parts[1])))]
    if "(" in text and " to " in text and len(parts) == 3:
        return [Figure(number(parts[0]), off, low=number(parts[1]), high=number(parts[2]))]
    return [Figure(number(part), 0.5 * digits(part) if "." in part else 0.0) for part in parts]


def one_or_all(found):
    return found[0] if len(found) == 1 else found


def flat(values):
    for value in values:
        if isinstance(value, (list, tuple)):
            yield from flat(value)
        else:
            yield plain(value)


def tables_of(text):
    """Each table: header and rows of cells."""
    found = []
    for block in re.findall(r"(?:^\|[^\n]*\n)+", text + "\n", re.MULTILINE):
        rows = [[cell.strip() for cell in line.strip().strip("|").split("|")] for line in block.strip().splitlines()]
        if len(rows) > 2 and set("".join(rows[1])) <= set("-: "):
            found.append((rows[0], rows[2:]))
    return found


class Page:
    def __init__(self, path):
        self.path, self.text = path, path.read_text(encoding="utf-8")
        self.tables = tables_of(self.text)
        self.blocks = "\n".join(BLOCK.findall(self.text))

    def root(self):
        return next(folder for folder in self.path.parents if (folder / "docs/results").is_dir())

    def cell(self, table, row, column):
        if not 1 <= table <= len(self.tables):
            raise Wrong(f"there is no table {table}")
        header, rows = self.tables[table - 1]
        header = [f"#{i + 1}" if column.startswith("#") else name for i, name in enumerate(header)]
        wanted = [part.strip() for part in row.split("|")]
        columns = [i for part in column.split("|") for i, name in enumerate(header) if fnmatch.fnmatchcase(name, part.strip())]
        found = [figure for cells in rows if all(fnmatch.fnmatchcase(cell.replace("*", ""), part) for cell, part in zip(cells, wanted))
                 for i in columns for figure in figures_of(cells[i])]
        if not found:
            raise Wrong(f"table {table} has no figure in row '{row}', column '{column}'")
        return one_or_all(found)

    def printed(self, pattern):
        found = re.search(pattern, self.blocks)
        if not found:
            raise Wrong(f"no command prints '{pattern}'")
        return one_or_all([Figure(number(part)) for part in found.groups()])

    def kept(self, paradigm, axes, measure):
        """The kept answer's estimate of a paradigm at a point."""
        answer = json.loads((self.root() / f"tests/golden/results/{self.path.stem}.json").read_text(encoding="utf-8"))
        wanted = dict(item.strip().split("=", 1) for item in axes.split(",")) if axes else {}
        found = [point for point in answer["points"] if all(point["axes"].get(axis) == value for axis, value in wanted.items())]
        if len(found) != 1 or measure not in found[0]["paradigms"].get(paradigm, {}):
            raise Wrong(f"the kept answer has {len(found)} points with {axes}, or no {measure} of {paradigm}")
        return found[0]["paradigms"][paradigm][measure]

    def change(self, paradigm, axes, measure):
        percent = self.kept(paradigm, axes, measure)["difference"]["percent"]
        return Figure(percent["mean"], low=percent["low"], high=percent["high"])

    def paragraphs(self):
        """Each paragraph that has a directive, with the directive."""
        for match in SAYS.finditer(self.text):
            before = self.text[:match.start()].rstrip()
            yield COMMENT.sub("", before[before.rfind("\n\n") + 2:]), match[1]

    def answer(self):
        """The text before the first heading, command or table, without the title."""
        body = self.text.split("\n", 1)[1]
        return re.split(r"^(?:#|    |\||```|<!-- table)", body, maxsplit=1, flags=re.MULTILINE)[0]

    def sections(self, *begins):
        """The text from each of these beginnings of lines to the next heading, tables included."""
        found = [re.search(rf"^{re.escape(begin)}.*?(?=^#|\Z)", self.text, re.DOTALL | re.MULTILINE) for begin in begins]
        if None in found:
            raise Wrong(f"no line begins with '{begins[found.index(None)]}'")
        return "\n\n".join(match[0] for match in found)


def read(text):
    return UNREAD.sub(" ", " ".join(ITEM.sub("", text).split()))


def span(*values):
    every = sorted(flat(values))
    return every[0], every[-1]


def each(of, values, bases):
    values, bases = list(flat([values])), list(flat([bases]))
    if len(bases) == 1:
        bases *= len(values)
    if len(values) != len(bases):
        raise Wrong(f"{len(values)} cells have {len(bases)} bases")
    return one_or_all([of(value, base) for value, base in zip(values, bases)])


def ends(value):
    if value.half is not None:
        return Figure(value.value - value.half, value.off), Figure(value.value + value.half, value.off)
    return value.low, value.high


def ends_of(values):
    """Both ends of each interval. The means are not among them."""
    return [plain(end) for value in flat([values]) for end in (ends(value) if ends(value)[0] is not None else (value, value))]


def half(value):
    """An interval's half width, with the rounding of its last digit."""
    if value.half is None:
        raise Wrong("has no half width")
    return Figure(value.half, value.off)


def signed(values):
    return [value for value in flat([values]) if ends(value)[0] * ends(value)[1] > 0]


def names_of(page):
    def of(other, table, row, column):
        return Page(page.root() / f"docs/results/{other}.md").cell(table, row, column)
    return {"__builtins__": {}, "abs": abs, "len": len, "t": page.cell, "of": of, "printed": page.printed, "span": span,
            "share": lambda v, b: each(lambda x, y: 100 * x / y, v, b),
            "least": lambda *v: span(*v)[0], "most": lambda *v: span(*v)[1], "ratio": lambda v, b: each(lambda x, y: x / y, v, b),
            "minus": lambda v, b: each(lambda x, y: x - y, v, b), "signed": signed, "ends": ends_of, "half": half, "plus": lambda v, b: each(lambda x, y: x + y, v, b), "squared": lambda x: x * x,
            "between": lambda v, low, high: [x for x in flat([v]) if low <= x.value <= high], "change": page.change,
            "kept": lambda *asked: Figure(page.kept(*asked)["mean"])}


def parts_of(words):
    """(figure, the most that it may be off by) of a FIGURE's words, in order."""
    if found := NUMBER.findall(words):
        return [(number(part), 0.5 * digits(part)) for part in found]
    found = [(match.start(), PARTS[match[2].lower()] * WORDS.get((match[1] or "a").lower(), 1)) for match in FRACTION.finditer(words)]
    if found:
        return [(value, OFF * value) for _, value in found]
    return [(WORDS[word], 0.0) for word in re.findall(r"[a-z]+", words.lower()) if word in WORDS]


def wanted_of(result, many):
    values = list(flat([result]))
    if len(values) == 1 and many == 2:
        return [values[0], plain(math.nan if values[0].half is None else values[0].half)]
    if len(values) == 1 and many == 3:
        return [values[0], *(plain(math.nan if end is None else end) for end in (values[0].low, values[0].high))]
    return values


def problem_of(words, expression, page):
    """Why a figure does not follow, or ""."""
    try:
        result = eval(expression, names_of(page))  # the page's own words, with the names above alone
    except (Wrong, TypeError, NameError, SyntaxError, ValueError, ZeroDivisionError, OSError, AttributeError, LookupError,
            re.error) as wrong:
        return f"'{words}': {expression}: {wrong}"
    parts = parts_of(words)
    values = wanted_of(result, len(parts))
    if not parts or len(parts) != len(values):
        return f"'{words}' has {len(parts)} figures, and {expression} gives {len(values)}"
    for (figure, allowed), value in zip(parts, values):
        if not abs(figure - value.value) <= (allowed + value.off) * (1 + 1e-9):
            shown = ", ".join(f"{one.value:.4g}" for one in values)
            return f"'{words}' is {shown} by {expression}"
    return ""


def entries_of(directive):
    for entry in directive.split(";"):
        entry = " ".join(entry.split())
        key, _, listed = entry.partition(": ")
        if key in ("given", "apart"):
            yield from ((key, words.strip(), "") for words in listed.split(", "))
        elif " = " in entry:
            words, expression = entry.split(" = ", 1)
            yield "held", words.strip(), expression.strip()
        elif entry:
            raise Wrong(f"'{entry}' must be FIGURE = EXPRESSION, given: WORDS or apart: WORDS")


def problems_of(page, counts):
    """One line for each figure of the page that does not follow. `counts` has the figures by their kind."""
    found = []
    for paragraph, directive in page.paragraphs():
        text, taken = read(paragraph), []
        for kind, words, expression in entries_of(directive):
            at = next((match.start() for match in re.finditer(rf"(?<![\w.,+-]){re.escape(words)}(?!\w|[.,]\d)", text)
                       if not any(match.start() < end and start < match.end() for start, end in taken)), None)
            if at is None:
                found.append(f"'{words}' is not in the paragraph: {text[:60]} ...")
                continue
            taken.append((at, at + len(words)))
            counts[kind] = counts.get(kind, 0) + 1
            if kind == "held" and (problem := problem_of(words, expression, page)):
                found.append(problem)
        found += [f"{match[0]} is not accounted for: ... {text[max(0, match.start() - 40):match.end() + 20]} ..."
                  for match in NUMBER.finditer(text) if not any(start <= match.start() < end for start, end in taken)]
    return found


def unheld(answer):
    """Paragraphs of an answer with figures and without a directive."""
    return [f"the answer has figures and no <!-- says: ... -->: {read(block)[:60]} ..." for block in answer.strip().split("\n\n")
            if "<!-- says:" not in block and NUMBER.search(read(COMMENT.sub("", block)))]


def problems_of_answers(index):
    """Figures of docs/results.md's answers that the answers of their pages have not."""
    found = []
    for header, rows in tables_of(index.text):
        if header != ["question", "answer"]:
            continue
        for question, answer in rows:
            link = re.search(r"\(results/(\w+\.md)\)", question)
            page = Page(index.path.parent / "results" / link[1])
            there = {number(part) for part in NUMBER.findall(read(COMMENT.sub("", page.answer())).replace("−", "-"))}
            found += [f"{link[1]}: {part} is not in the page's answer" for part in NUMBER.findall(read(answer)) if number(part) not in there]
    return found


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    counts, failed = {}, 0
    index, readme = root / "docs/results.md", root / "README.md"
    answers = {index: ("**The short answer.**", "## The range"), readme: ("**The answer.**",)}
    pages = [*sorted((root / "docs/results").glob("*.md")), index, readme]
    for path in pages:
        page = Page(path)
        try:
            found = problems_of(page, counts) + unheld(page.sections(*answers[path]) if path in answers else page.answer())
        except Wrong as wrong:
            found = [str(wrong)]
        found += problems_of_answers(page) if path == index else []
        for line in found:
            print(f"{path.relative_to(root)}: {line}")
        failed += len(found)
    if not failed:
        print(f"{len(pages)} pages: {counts.get('held', 0)} figures follow from tables, {counts.get('given', 0)} are conditions, "
              f"{counts.get('apart', 0)} are of no table")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
