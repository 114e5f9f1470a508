#!/usr/bin/env python3
"""Writes the small golden pack and what its poses must give: `python3 tests/golden/make_golden.py`.

The reference of tests/tests/golden.rs: float64, the standard library only, and no code in common with the
crates. It makes the pack's files first and then reads them back, so that the results belong to the very bytes.

Conventions as in rig-core: column vectors, T = T_parent B L, X = T inverse(W); L is the product of the listed
rotations, left to right, in degrees, right-handed, in the joint's frame.
"""

import json
import math
import random
import struct
import xml.etree.ElementTree
from pathlib import Path

HERE = Path(__file__).resolve().parent
PACK = HERE / "pack"
BONES = ["NeckJoint", "HeadJoint", "LtUpperLidJoint", "RtUpperLidJoint", "LtLowerLidJoint",
         "RtLowerLidJoint", "JawJoint", "LtEyeJoint", "RtEyeJoint"]
RIGID = {"UpperJaw": "HeadJoint", "LowerJaw": "JawJoint", "RtEyeBall_smtt": "RtEyeJoint",
         "LtEyeBall_smtt": "LtEyeJoint", "RtEyeTransp_smtt": "RtEyeJoint", "LtEyeTransp_smtt": "LtEyeJoint"}
POSES = [
    ("bind", {}, 0, 0),
    ("smile", {}, 1, 0),
    ("half smile, half frown", {}, 0.5, 0.5),
    ("beyond the shapes", {}, 1.5, -0.75),
    ("jaw open and to the side", {"JawJoint": [["z", -15], ["y", 6]]}, 0, 0),
    ("head turned, bowed and bent", {"HeadJoint": [["x", 35], ["y", 20], ["z", -15]]}, 0.25, 0),
    ("lids closed", {"LtUpperLidJoint": [["z", -40]], "RtUpperLidJoint": [["z", -40]],
                     "LtLowerLidJoint": [["z", 20]], "RtLowerLidJoint": [["z", 20]]}, 0, 0),
    ("eyes crossed, one up", {"LtEyeJoint": [["z", 12], ["y", -25]], "RtEyeJoint": [["z", -4], ["y", 25]]}, 0, 0),
    ("everything", {"NeckJoint": [["y", 10], ["x", -20], ["y", 5], ["z", 8]],
                    "HeadJoint": [["z", 12], ["x", -30]], "JawJoint": [["y", -5], ["z", -18]],
                    "LtUpperLidJoint": [["z", -33.5]], "RtLowerLidJoint": [["z", 11.25]],
                    "LtEyeJoint": [["y", 17]], "RtEyeJoint": [["z", -9], ["y", 3]]}, 0.8, 0.35),
]


# 4×4 matrices as lists of rows.

def multiply(a, b):
    return [[sum(a[r][k] * b[k][c] for k in range(4)) for c in range(4)] for r in range(4)]


def rotation(axis, degrees):
    cos, sin = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    m = [[float(r == c) for c in range(4)] for r in range(4)]
    m[j][j], m[j][k], m[k][j], m[k][k] = cos, -sin, sin, cos
    return m


def at(rotated, x, y, z):
    return [row[:3] + [offset] for row, offset in zip(rotated, (x, y, z))] + [[0.0, 0.0, 0.0, 1.0]]


def inverse(m):
    """Gauss and Jordan: any invertible matrix, so that the crates' rigid inverse is held against a true one."""
    rows = [list(map(float, m[r])) + [float(r == c) for c in range(4)] for r in range(4)]
    for column in range(4):
        pivot = max(range(column, 4), key=lambda r: abs(rows[r][column]))
        rows[column], rows[pivot] = rows[pivot], rows[column]
        rows[column] = [x / rows[column][column] for x in rows[column]]
        for r in range(4):
            if r != column:
                factor = rows[r][column]
                rows[r] = [x - factor * y for x, y in zip(rows[r], rows[column])]
    return [row[4:] for row in rows]


def transform(m, v, w):
    return [sum(m[r][k] * v[k] for k in range(3)) + w * m[r][3] for r in range(3)]


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return [x / length for x in v]


# The pack.

def world_frames():
    """Head: x up, y to the character's left, z backward. Jaw, lids, eyes: z to the character's right; eyes: x
    forward, y up. Right lids are left lids turned by 180 degrees about z."""
    up_left_back = [[0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    forward_up_right = [[0.0, 0.0, -1.0, 0.0], [0.0, 1.0, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0]]
    frames = {"NeckJoint": at(multiply(up_left_back, rotation("y", 5)), 0, -13.5, -2.25),
              "HeadJoint": at(up_left_back, 0, -10.25, -1.5),
              "JawJoint": at(multiply(forward_up_right, rotation("z", 216)), 0, -3.5, -1.75)}
    for side, x in (("Lt", 3.25), ("Rt", -3.25)):
        turn = 0 if side == "Lt" else 180
        frames[side + "UpperLidJoint"] = at(multiply(forward_up_right, rotation("z", 28 + turn)), x, 0.25, 1.5)
        frames[side + "LowerLidJoint"] = at(multiply(forward_up_right, rotation("z", -31 + turn)), x, 0.25, 1.5)
        frames[side + "EyeJoint"] = at(forward_up_right, x, 0.25, 1.5)
    return frames


def write_rig():
    frames = world_frames()

    def joint(name, parent, layout, omit="", children=()):
        bind = frames[name] if parent is None else multiply(inverse(frames[parent]), frames[name])
        numbers = [list(column) for column in zip(*bind)] if layout == columns else bind
        out = [f'<Joint name="{name}"{omit}>', f"  <Matrix{layout}>"]
        # Rounded before, so that the noise of the sixteenth digit prints as 0.
        out += ["    " + "  ".join(f"{round(x, 12) + 0.0:.9g}" for x in row) for row in numbers] + ["  </Matrix>"]
        if children:
            out += ["  <Children>"] + ["    " + line for child in children for line in child] + ["  </Children>"]
        return out + ["</Joint>"]

    columns, rows, also_rows = ' transposed="true"', "", ' transposed="false"'
    # Neither the order of the bones nor one layout throughout: names decide, and each matrix says how it
    # runs.
    head = [joint("RtEyeJoint", "HeadJoint", rows, ' omit="true"'),
            joint("JawJoint", "HeadJoint", columns),
            joint("LtLowerLidJoint", "HeadJoint", columns),
            joint("RtLowerLidJoint", "HeadJoint", also_rows),
            joint("LtEyeJoint", "HeadJoint", columns, ' omit="true"'),
            joint("RtUpperLidJoint", "HeadJoint", rows),
            joint("LtUpperLidJoint", "HeadJoint", columns)]
    body = joint("NeckJoint", None, columns, "", [joint("HeadJoint", "NeckJoint", columns, "", head)])
    text = ['<?xml version="1.0" encoding="UTF-8"?>', "<!-- Made by make_golden.py. -->", "<JointSet>"]
    text += ["  " + line for line in body] + ["</JointSet>", ""]
    (PACK / "Transformations.xml").write_text("\n".join(text), encoding="utf-8", newline="\n")


def write_part(stem, vertices, triangles):
    (PACK / f"{stem}_VB.raw").write_bytes(b"".join(struct.pack(f"<{len(v)}f", *v) for v in vertices))
    (PACK / f"{stem}_IB.raw").write_bytes(b"".join(struct.pack("<3I", *t) for t in triangles))


def grid(columns, rows):
    """Triangles of a grid of points, counter-clockwise where u runs to the right and v downward."""
    quads = [(r * columns + c, (r + 1) * columns + c) for r in range(rows - 1) for c in range(columns - 1)]
    return [t for a, b in quads for t in ((a, b, b + 1), (a, b + 1, a + 1))]


def write_skin(rng):
    columns, rows, vertices = 8, 6, []
    for r in range(rows):
        for c in range(columns):
            u, v = c / (columns - 1), r / (rows - 1)
            longitude, latitude = (u - 0.5) * 4.0, (0.5 - v) * 2.6
            n = [math.cos(latitude) * math.sin(longitude), math.sin(latitude), math.cos(latitude) * math.cos(longitude)]
            p = [7.5 * n[0], 11.0 * n[1] - 2.0, 8.0 * n[2] - 3.0]
            bones = rng.sample(range(9), 4)
            weights = unit_sum([rng.random() ** 2 for _ in range(4)][: 1 + (r + c) % 4])
            offsets = []
            for scale in (1.2, 0.9):
                offsets += [rng.uniform(-scale, scale) for _ in range(3)] + [rng.uniform(-0.3, 0.3) for _ in range(3)]
            vertices.append(p + [u, v] + n + bones + weights + [0, 1, 0] + offsets)
    write_part("MarsienneSkin", vertices, grid(columns, rows))


def unit_sum(weights):
    total = sum(weights)
    return [w / total for w in weights] + [0.0] * (4 - len(weights))


def write_rigid_parts():
    for stem, y, bulge in (("UpperJaw", -4.0, 1.0), ("LowerJaw", -6.0, -1.0)):
        vertices = []
        for r in range(3):
            for c in range(6):
                u, v = c / 5, r / 2
                n = unit([u - 0.5, 0.2 * bulge, 1.0])
                vertices.append([4 * (u - 0.5), y - v, 3.0 - 4 * (u - 0.5) ** 2] + [5.33 * u, v] + n)
        write_part(stem, vertices, grid(6, 3))
    # The right eye is the mirror image of the left one, with its triangles: inside out, as in the original.
    for kind, radius, reach in (("EyeBall", 1.5, math.pi), ("EyeTransp", 1.58, 0.9)):
        for side, mirror in (("Lt", 1.0), ("Rt", -1.0)):
            vertices = []
            for r in range(5):
                for c in range(7):
                    u, v = c / 6, r / 4
                    around, out = 2 * math.pi * u, reach * v
                    n = [mirror * math.sin(out) * math.cos(around), math.sin(out) * math.sin(around), math.cos(out)]
                    p = [mirror * 3.25 + radius * n[0], 0.25 + radius * n[1], 1.5 + radius * n[2]]
                    vertices.append(p + [u, v] + n)
            write_part(f"{side}{kind}_smtt", vertices, grid(7, 5))


# The results, from the files.

def read_rig():
    joints = {}

    def visit(element, parent):
        matrix = element.find("Matrix")
        numbers = [struct.unpack("<f", struct.pack("<f", float(word)))[0] for word in matrix.text.split()]
        rows = [numbers[4 * r: 4 * r + 4] for r in range(4)]
        if matrix.get("transposed") == "true":
            rows = [list(row) for row in zip(*rows)]
        joints[element.get("name")] = (parent, rows)
        for child in element.findall("Children/Joint"):
            visit(child, element.get("name"))

    for root in xml.etree.ElementTree.parse(PACK / "Transformations.xml").getroot():
        visit(root, None)
    return joints


def world(joints, name, rotations):
    """T of a joint; W without rotations."""
    parent, m = joints[name]
    for axis, degrees in rotations.get(name, []):
        m = multiply(m, rotation(axis, degrees))
    return m if parent is None else multiply(world(joints, parent, rotations), m)


def read_vertices(stem, floats):
    return list(struct.iter_unpack(f"<{floats}f", (PACK / f"{stem}_VB.raw").read_bytes()))


def deform_skin(vertices, x, smile, frown):
    points, normals = [], []
    for v in vertices:
        p = [v[k] + smile * v[19 + k] + frown * v[25 + k] for k in range(3)]
        n = [v[5 + k] + smile * v[22 + k] + frown * v[28 + k] for k in range(3)]
        terms = [(v[12 + i], x[BONES[int(v[8 + i])]]) for i in range(4)]
        points.append([sum(w * transform(m, p, 1)[k] for w, m in terms) for k in range(3)])
        normals.append(unit([sum(w * transform(m, n, 0)[k] for w, m in terms) for k in range(3)]))
    return points, normals


def rounded(values):
    return [round(value, 7) + 0.0 for value in values]


def box(points):
    return {"sum": rounded(sum(p[k] for p in points) for k in range(3)),
            "min": rounded(min(p[k] for p in points) for k in range(3)),
            "max": rounded(max(p[k] for p in points) for k in range(3))}


def case(joints, name, rotations, smile, frown):
    t = {joint: world(joints, joint, rotations) for joint in BONES}
    x = {joint: multiply(t[joint], inverse(world(joints, joint, {}))) for joint in BONES}
    skin = read_vertices("MarsienneSkin", 31)
    points, normals = deform_skin(skin, x, smile, frown)
    whole = box(points)
    parts = {}
    for stem, joint in RIGID.items():
        vertices = read_vertices(stem, 8)
        parts[stem] = box([transform(x[joint], v[:3], 1) for v in vertices])
        parts[stem]["normal_sum"] = rounded(
            sum(unit(transform(x[joint], v[5:8], 0))[k] for v in vertices) for k in range(3))
    return {"pose": name, "rotations": rotations, "SSmile": smile, "Frown": frown,
            "skin_sum": whole["sum"], "skin_min": whole["min"], "skin_max": whole["max"],
            "max_move": round(max(math.dist(p, v[:3]) for p, v in zip(points, skin)), 7),
            "vertices": {str(i): {"p": rounded(points[i]), "n": rounded(normals[i])} for i in range(len(skin))},
            "joint_world_translation": {joint: rounded(t[joint][r][3] for r in range(3)) for joint in BONES},
            "skin_matrices_rowmajor": {joint: rounded(value for row in x[joint] for value in row) for joint in BONES},
            "parts": parts}


def main():
    PACK.mkdir(exist_ok=True)
    rng = random.Random(2)
    write_rig()
    write_skin(rng)
    write_rigid_parts()
    joints = read_rig()
    about = {"title": "the small golden pack", "joint_order": BONES}
    cases = [case(joints, *pose) for pose in POSES]
    # A line for each entry of each case, so that a difference is easy to find.
    entries = [",\n  ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in c.items()) for c in cases]
    head = "".join(f"{json.dumps(key)}: {json.dumps(value)},\n" for key, value in about.items())
    text = "{\n" + head + '"cases": [\n{' + "},\n{".join(entries) + "}\n]\n}\n"
    (HERE / "expected.json").write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
