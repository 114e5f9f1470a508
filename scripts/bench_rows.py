"""The rows of the table of docs/performance.md: what each compares, and its goal."""

import dataclasses
import typing

import bench_table as table

FACES = 1024


@dataclasses.dataclass
class Row:
    """One number of the table; `lines` makes its lines of the series that there are."""

    number: int
    needs: list
    lines: typing.Callable

    def cells(self, series):
        return [[self.number, *cells] for cells in self.lines(lambda key: series.get(key, []))]


def _line(what, ours, goal, beside="", theirs=(), unit="s"):
    """Cells of a line; the unit stands behind what is measured."""
    against = table.ratio(ours, theirs) if ours and theirs else None
    return [
        f"{what}, {unit}",
        table.summary(ours),
        beside if theirs else "",
        table.summary(list(theirs)),
        "" if against is None else f"**{table.number(against)}**",
        goal,
    ]


def _render(get):
    yield _line("`render --hair off`, from the start to the file", get("render"), "≤ 0.8", unit="s")


def _hair(get):
    yield _line("`render --hair bob --quality high`", get("bob high"), "≤ 4", unit="s")
    yield _line(
        "`render --hair bob --quality low`",
        get("bob low"),
        "≤ 2 × without",
        "the same without hair",
        get("bald low"),
        "s",
    )


def _window(get):
    yield _line("window in motion, with a bob", get("window"), "≥ 20", unit="pictures a second")


def _sheet(get):
    yield _line("`sheet` of all poses", get("sheet"), "≤ 5", unit="s")


def _whole(get, quality, count, way="as a crowd"):
    """Milliseconds of a frame in which all avatars of a crowd move."""
    return table.added(*(get(f"{quality} {count} {way} {part}") for part in ("pose", "record", "frame")))


def _avatars(get):
    for quality, light, goal in [("Plain", "unlit", "≤ 0.25"), ("Low", "lit", "≤ 0.35")]:
        one, many = get(f"bevy {light} 1"), get(f"bevy {light} 16")
        first = _whole(get, quality, 1)
        bevy = f"Bevy 0.19.1, {'unlit' if light == 'unlit' else 'physical, without shadows'}"
        yield _line(f"one avatar, {quality.lower()}", first, "", bevy, one, "ms")
        theirs = table.further(many, one, 16)
        for way, name in [("as a crowd", "the whole face"), ("by level", "level of detail")]:
            more = table.further(_whole(get, quality, 16, way), _whole(get, quality, 1, way), 16)
            yield _line(f"each further one of 16, {quality.lower()}, {name}", more, goal, bevy, theirs, "ms")


def _recording(get):
    for quality in ("Plain", "Low"):
        record = get(f"{quality} 1000 as a crowd record")
        one_by_one = get(f"{quality} 1000 one by one record")
        yield _line(
            f"recording 1,000 avatars, {quality.lower()}", record, "≤ 2", "one by one", one_by_one, "ms"
        )


def _a_face(series):
    """Nanoseconds of one face, of seconds of all."""
    return table.scaled(series, 1e9 / FACES)


def _faces(get):
    crowd, single = _a_face(get("avatar-pack built_in_crowd")), _a_face(get("avatar-pack built_in_one_by_one"))
    what = "a face of 1,024: player, couplings, bones"
    yield _line(what, crowd, "≤ 120", "one by one", single, "ns")
    bones = _a_face(get("rig-core crowd/1024"))
    ozz = get("ozz-animation-rs")
    yield _line("its nine joints alone", bones, "≤ 30, ≤ 0.25", "ozz-animation-rs 0.11.0", ozz, "ns")
    yield _line("its nine joints alone", bones, "", "glam 0.34, one by one", get("glam"), "ns")


def _speed(get, what, goal, key, beside="a copy of as many bytes"):
    """Microseconds beside those of a copy of as many bytes; the ratio is that of bytes per second."""
    ours, copy = get(key), get(f"{key}: copy")
    cells = _line(what, ours, goal, beside, copy, "µs")
    share = table.ratio(copy, ours) if ours and copy else None
    cells[4] = "" if share is None else f"**{table.number(share)}** of its speed"
    yield cells


def _loading(get):
    yield from _speed(get, "load the built-in pack, without textures", "≥ 0.35", "load the built-in pack")


def _deforming(get):
    for count, word in enumerate(["no shape", "one shape", "two shapes"]):
        yield from _speed(get, f"deform its skin on the CPU, {word}", "≥ 0.5", f"deform its skin, {count} shapes")
    for count, word in [(0, "no shape"), (1, "one shape"), (2, "two shapes"), (20, "20 small shapes")]:
        what = f"deform its skin on the adapter, {word}"
        yield from _speed(get, what, "≥ 0.5", f"deform on the adapter, {count} shapes", "a kernel that copies as many")
    yield from _speed(get, "growth of 100,000 strands", "≥ 0.5", "growth", "a kernel that copies as many")


def _still(get):
    for quality in ("Plain", "Low"):
        still, moving = get(f"{quality} 16 as a crowd still"), _whole(get, quality, 16)
        what = f"a frame of 16 avatars that keep still, {quality.lower()}"
        yield _line(what, still, "no deformation", "all of them move", moving, "ms")


ROWS = [
    Row(1, ["render"], _render),
    Row(2, ["bob high", "bob low", "bald low"], _hair),
    Row(3, ["window"], _window),
    Row(4, ["sheet"], _sheet),
    Row(5, ["crowd", "bevy"], _avatars),
    Row(6, ["crowd"], _recording),
    Row(7, ["faces", "bones", "ozz"], _faces),
    Row(8, ["floor"], _loading),
    Row(9, ["floor", "adapter deform", "growth"], _deforming),
    Row(10, ["crowd"], _still),
]
