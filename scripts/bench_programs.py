"""The programs that scripts/bench runs, ours and others, how they are built, and what is read of their output."""

import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

import bench_table as table
import bench_window as window
from bench_window import Missing

OZZ = "ozz-animation-rs"
OZZ_VERSION = "0.11.0"
COUNTS = [1, 4, 16]


def tell(text):
    print(f"bench: {text}", file=sys.stderr, flush=True)


def output(command, **options):
    """What a command prints. Raises Missing with its last words where it fails or is not there."""
    try:
        done = subprocess.run(command, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **options)
    except OSError as error:
        raise Missing(f"{command[0]}: {error.strerror}") from error
    if done.returncode != 0:
        words = (done.stderr.strip() or done.stdout.strip()).splitlines() or ["no message"]
        # Compilers say "build failed" last.
        words = [line for line in words if line.startswith("error")] or words[-1:]
        raise Missing(f"{pathlib.Path(command[0]).name} ended with {done.returncode}: {words[0]}")
    return done.stdout


def processor():
    """The name of the processor, without what all of them say of themselves."""
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return re.sub(r"\((R|TM)\)| CPU| Processor| @.*", "", line.split(":", 1)[1]).strip()
    return "an unknown processor"


class Load:
    """How much of the machine other processes use from now on."""

    def __init__(self):
        self.start, self.busy, self.own = time.monotonic(), self._busy(), self._own()

    @staticmethod
    def _busy():
        user, nice, system, *_ = pathlib.Path("/proc/stat").read_text(encoding="utf-8").split("\n")[0].split()[1:]
        return (int(user) + int(nice) + int(system)) / os.sysconf("SC_CLK_TCK")

    @staticmethod
    def _own():
        uses = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(use.ru_utime + use.ru_stime for use in uses)

    def others(self):
        available = (time.monotonic() - self.start) * os.cpu_count()
        used = self._busy() - self.busy - (self._own() - self.own)
        return max(0.0, used / available)


class Program:
    """One that is built. `measure` runs it once and returns {key: (least, median)}, or raises Missing."""

    def __init__(self, name, measure):
        self.name, self.measure = name, measure


def run_in_turns(ready, rounds, leave_out):
    """Every program once in each round: {key: [(least, median), …]}, a pair for each round.

    One that fails once is left out altogether, so that rounds of all series are the same rounds.
    """
    kept = {program: [] for program in ready}
    for turn in range(rounds):
        for program in list(kept):
            tell(f"round {turn + 1} of {rounds}: {program.name}")
            try:
                kept[program].append(program.measure())
            except Missing as missing:
                leave_out(f"{program.name}: {missing}")
                del kept[program]
    series = {}
    for found in kept.values():
        for pairs in found:
            for key, pair in pairs.items():
                series.setdefault(key, []).append(pair)
    return series


class Workshop:
    """Where programs are built, what they share, and what could not be had."""

    def __init__(self, root, given, scratch):
        self.root, self.given, self.scratch = root, given, pathlib.Path(scratch)
        self.left_out, self.adapter = [], ""

    def leave_out(self, what):
        if what not in self.left_out:
            tell(f"left out: {what}")
            self.left_out.append(what)

    def viewer(self):
        if self.given.viewer is None:
            tell("building a release of the viewer")
            cargo = ["cargo", "build", "--release", "--package", "avatar-viewer"]
            self.given.viewer = self._built(cargo, "avatar-viewer")
        if not self.given.viewer.is_file():
            raise Missing(f"there is no program {self.given.viewer}")
        return self.given.viewer.resolve()

    def bench(self, package, name):
        tell(f"building the bench {name} of {package}")
        return self._built(["cargo", "bench", "--no-run", "--package", package, "--bench", name], name)

    def _built(self, command, name):
        """The program of that name among what cargo says it has built."""
        for line in output([*command, "--message-format=json"], cwd=self.root).splitlines():
            message = json.loads(line) if line.startswith("{") else {}
            if message.get("executable") and message["target"]["name"] == name:
                return pathlib.Path(message["executable"])
        raise Missing(f"cargo built no {name}")

    def peer(self, name):
        """Builds one of scripts/peers outside of the repository."""
        if self.given.no_peers:
            raise Missing("other programs were not asked for")
        folder = self.given.peers.resolve()
        built = folder / name / "release" / f"peer-{name}"
        if self.given.quick and not built.is_file():
            raise Missing("not built yet, which --quick does not wait for")
        source = folder / "src" / name
        shutil.copytree(self.root / "scripts" / "peers" / name, source, dirs_exist_ok=True)
        environment = dict(os.environ)
        if name == "ozz":
            self._patch_ozz(source)
            # For core::simd, which it is written with.
            environment["RUSTC_BOOTSTRAP"] = "1"
        tell(f"building peer-{name} in {folder}, for the first time with everything that it depends on")
        cargo = ["cargo", "build", "--release", "--target-dir", folder / name]
        # Not with the flags and settings of this repository.
        output(cargo, cwd=source, env=environment)
        return built

    @staticmethod
    def _patch_ozz(source):
        """Puts its source beside the program, with the new name of a function of core::simd."""
        there = source / OZZ
        if there.is_dir():
            return
        cargo_home = pathlib.Path(os.environ.get("CARGO_HOME") or pathlib.Path.home() / ".cargo")
        with tempfile.TemporaryDirectory() as empty:
            pathlib.Path(empty, "lib.rs").touch()
            manifest = '[package]\nname = "fetch"\n[lib]\npath = "lib.rs"\n[workspace]\n[dependencies]\n'
            pathlib.Path(empty, "Cargo.toml").write_text(f'{manifest}{OZZ} = "={OZZ_VERSION}"\n', encoding="utf-8")
            output(["cargo", "fetch"], cwd=empty)
        found = sorted(cargo_home.glob(f"registry/src/*/{OZZ}-{OZZ_VERSION}"))
        if not found:
            raise Missing(f"the source of {OZZ} {OZZ_VERSION}")
        shutil.copytree(found[0], there)
        math = there / "src" / "math.rs"
        math.write_text(math.read_text(encoding="utf-8").replace(".to_int()", ".to_simd()"), encoding="utf-8")

    def scene(self):
        """The same avatar as a GLB and in the raw format."""
        if self.given.scene is None:
            shared = self.root.parent / "shared"
            script, pack = shared / "peers" / "pack2glb.py", shared / "data" / "avatar-course-format-makehuman"
            if not script.is_file() or not pack.is_dir():
                raise Missing("no avatar of 63,488 vertices (--scene, --pack)")
            glb, padded = self.scratch / "scene.glb", self.scratch / "pack"
            output([sys.executable, "-B", script, pack, glb, "--pad", "63488", "--write-pack", padded])
            self.given.scene, self.given.pack = glb, padded
        for path in (self.given.scene, self.given.pack):
            if not path.exists():
                raise Missing(f"there is no {path}")
        return self.given.scene.resolve(), self.given.pack.resolve()


def all_programs(workshop, wanted):
    """Those of the wanted names that can be had, in the order in which each round runs them."""
    for name, prepare in PROGRAMS.items():
        if name not in wanted:
            continue
        try:
            yield from prepare(workshop)
        except Missing as missing:
            workshop.leave_out(f"{name}: {missing}")


def _viewer(*arguments, key):
    def prepare(workshop):
        program, picture = workshop.viewer(), workshop.scratch / "picture.png"

        def measure():
            start = time.monotonic()
            output([program, *arguments, "--out", picture])
            seconds = time.monotonic() - start
            return {key: (seconds, seconds)}

        yield Program(key, measure)

    return prepare


def _window(workshop):
    program = workshop.viewer()
    seconds = 3 if workshop.given.quick else 10

    def measure():
        rate = window.pictures_a_second([program, "--hair", "bob"], seconds, workshop.scratch)
        return {"window": (rate, rate)}

    yield Program("window", measure)


def _divan(package, name):
    def prepare(workshop):
        program = workshop.bench(package, name)
        short = ["--sample-count", "10"] if workshop.given.quick else []

        def measure():
            found = table.divan(output([program, "--bench", *short]))
            return {f"{package} {bench}": pair for bench, pair in found.items()}

        yield Program(f"{package} {name}", measure)

    return prepare


def _floor(workshop):
    program = workshop.bench("avatar-pack", "floor")

    def measure():
        found = {}
        for name, (work, copy) in table.floor(output([program, "load", "deform"])).items():
            found[name], found[f"{name}: copy"] = work, copy
        return found

    yield Program("floor", measure)


def _growth(workshop):
    program = workshop.bench("avatar-render", "hair")

    def measure():
        return table.growth(output([program, "5", "100000", "growth"]))

    yield Program("growth", measure)


def _adapter_deform(workshop):
    program = workshop.bench("avatar-render", "deform")

    def measure():
        return table.adapter_deform(output([program]))

    yield Program("deform on the adapter", measure)


def _crowd(workshop):
    program = workshop.bench("avatar-render", "crowd")
    arguments = ["0.5" if workshop.given.quick else "4"]
    try:
        arguments.append(str(workshop.scene()[1]))
    except Missing as missing:
        workshop.leave_out(f"crowd: {missing}; the built-in avatar instead")

    def measure():
        text = output([program, *arguments])
        workshop.adapter = workshop.adapter or text.splitlines()[0]
        return {
            f"{quality} {count} {way} {column}": pair
            for (quality, count, way), columns in table.crowd(text).items()
            for column, pair in columns.items()
        }

    yield Program("crowd", measure)


def _bevy(workshop):
    # First: without it nothing has to be built.
    scene = workshop.scene()[0]
    program = workshop.peer("bevy")
    frames = "9" if workshop.given.quick else "60"
    for light in ("unlit", "lit"):
        for count in COUNTS:

            def measure(light=light, count=count):
                # The adapter that ours was measured on.
                adapter = [workshop.adapter.split(" (")[0]] if workshop.adapter else []
                text = output([program, scene, str(count), light, frames, *adapter])
                pair = table.labelled(text, "bevy")
                if pair is None:
                    raise Missing("no line of times")
                return {f"bevy {light} {count}": pair}

            yield Program(f"bevy {light} {count}", measure)


def _ozz(workshop):
    program = workshop.peer("ozz")

    def measure():
        text = output([program, "1024"])
        pairs = {name: table.labelled(text, name) for name in (OZZ, "glam")}
        return {name: pair for name, pair in pairs.items() if pair}

    yield Program("ozz", measure)


PROGRAMS = {
    "render": _viewer("render", "--hair", "off", key="render"),
    "bob high": _viewer("render", "--hair", "bob", "--quality", "high", key="bob high"),
    "bob low": _viewer("render", "--hair", "bob", "--quality", "low", key="bob low"),
    "bald low": _viewer("render", "--hair", "off", "--quality", "low", key="bald low"),
    "sheet": _viewer("sheet", key="sheet"),
    "window": _window,
    "crowd": _crowd,
    "bevy": _bevy,
    "faces": _divan("avatar-pack", "crowd"),
    "bones": _divan("rig-core", "crowd"),
    "ozz": _ozz,
    "floor": _floor,
    "adapter deform": _adapter_deform,
    "growth": _growth,
}
