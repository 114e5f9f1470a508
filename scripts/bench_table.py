"""What scripts/bench makes of the output of its programs: numbers, medians, and a table in a page.

A measurement is a pair, the least and the median of one run of a program, in the unit that the program prints.
A series is the list of measurements of all rounds.
"""

import re
import statistics

BEGIN = "<!-- scripts/bench writes from here -->"
END = "<!-- scripts/bench writes to here -->"
UNITS = {"ns": 1e-9, "µs": 1e-6, "us": 1e-6, "ms": 1e-3, "s": 1.0}


def divan(text):
    """Seconds of every bench in divan's tree, as {"bench": (least, median)}, {"bench/argument": …}."""
    found, path = {}, []
    for line in text.splitlines():
        row = re.match(r"^([│ ]*)[├╰]─ (\S+)\s*(.*)$", line)
        if not row:
            continue
        indent, name, columns = row.groups()
        path[len(indent) // 3 :] = [name]
        cells = [cell.strip() for cell in columns.split("│")]
        if len(cells) >= 3 and cells[0]:
            found["/".join(path)] = (_seconds(cells[0]), _seconds(cells[2]))
    return found


def _seconds(cell):
    number, unit = cell.split()
    return float(number) * UNITS[unit]


def floor(text):
    """Microseconds of avatar-pack's bench `floor`: {"name": (work, copy)}, both pairs."""
    found = {}
    for line in text.splitlines():
        row = re.match(r"^(\S.*?)\s+([\d.]+)\s+([\d.]+)\s+([\d.]+)\s+([\d.]+)\s+([\d.]+)$", line)
        if row:
            median, least, copy, copy_least = (float(cell) for cell in row.groups()[1:5])
            found[row.group(1)] = ((least, median), (copy_least, copy))
    return found


def crowd(text):
    """Milliseconds of avatar-render's bench `crowd`: {("Low", 16, "as a crowd"): {"pose": (least, median)}}."""
    found, quality, columns = {}, "", []
    for line in text.splitlines():
        if line.startswith("ms: least, median"):
            columns = line[len("ms: least, median") :].split()
        elif re.fullmatch(r"[A-Z][a-z]+", line):
            quality = line
        else:
            row = re.match(r"^(\d+) (as a crowd|by level|one by one) +([\d., ]+)$", line)
            if row:
                numbers = [float(number) for number in re.findall(r"\d+\.\d\d", row.group(3))]
                pairs = zip(numbers[::2], numbers[1::2])
                found[quality, int(row.group(1)), row.group(2)] = dict(zip(columns, pairs))
    return found


def growth(text):
    """Microseconds of growing hair, and of copying as many bytes, of avatar-render's bench `hair`."""
    row = re.search(r"growth alone ([\d.]+) ms.*copying .*: ([\d.]+) of it", text)
    if row is None:
        return {}
    growing = float(row.group(1)) * 1e3
    copying = growing * float(row.group(2))
    return {"growth": (growing, growing), "growth: copy": (copying, copying)}


def adapter_deform(text):
    """Microseconds of deforming on the adapter by the number of active shapes, and of copying as many bytes, of
    avatar-render's bench `deform`: {"deform on the adapter, 2 shapes": (work, work), "…: copy": (copy, copy)}."""
    found = {}
    for shapes, ms, share in re.findall(r"(\d+) active shapes: ([\d.]+) ms.*: ([\d.]+) of it", text):
        work = float(ms) * 1e3
        name = f"deform on the adapter, {shapes} shapes"
        found[name] = (work, work)
        found[f"{name}: copy"] = (work * float(share), work * float(share))
    return found


def labelled(text, label):
    """The pair after "least" and "median" in the line that begins with the label, or None."""
    for line in text.splitlines():
        row = re.search(r"least ([\d.]+), median ([\d.]+)", line)
        if line.startswith(label) and row:
            return float(row.group(1)), float(row.group(2))
    return None


def scaled(series, factor):
    """Each measurement of a series times a factor."""
    return [(least * factor, median * factor) for least, median in series]


def further(many, one, count):
    """What each avatar beyond the first costs, from the series of `count` of them and of one.

    A least that is less than the least of one, by noise, stays negative: it is to be seen, not hidden.
    """
    return [
        tuple((several - single) / (count - 1) for several, single in zip(pair, alone))
        for pair, alone in zip(many, one)
    ]


def added(*series):
    """The sums of several series, round by round."""
    return [tuple(sum(values) for values in zip(*pairs)) for pairs in zip(*series)]


def summary(series):
    """The median of the rounds' medians, and the least of all, as text; "" for nothing."""
    if not series:
        return ""
    return f"{number(statistics.median(median for _, median in series))} ({number(min(least for least, _ in series))})"


def ratio(ours, theirs):
    """The median over the rounds of how ours compares to theirs in the same round, or None."""
    pairs = [(ours_median, theirs_median) for (_, ours_median), (_, theirs_median) in zip(ours, theirs)]
    ratios = [a / b for a, b in pairs if b > 0]
    return statistics.median(ratios) if ratios else None


def number(value):
    """Three digits that matter, without an exponent."""
    if value == 0:
        return "0"
    magnitude = abs(value)
    digits = 0 if magnitude >= 100 else 1 if magnitude >= 10 else 2 if magnitude >= 1 else 3
    return f"{value:,.{digits}f}"


def table(header, rows):
    """A Markdown table."""
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(str(cell).replace("|", "\\|") for cell in line) + " |" for line in lines)


def between_markers(page, text):
    """The page with the text in place of what stands between the markers.

    Raises ValueError where the page has not exactly one of each, in order.
    """
    if page.count(BEGIN) != 1 or page.count(END) != 1 or page.index(BEGIN) > page.index(END):
        raise ValueError(f"expected one {BEGIN!r} before one {END!r}")
    before, rest = page.split(BEGIN)
    _, after = rest.split(END)
    return f"{before}{BEGIN}\n\n{text.strip()}\n\n{END}{after}"
