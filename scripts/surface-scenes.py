#!/usr/bin/env python3
"""Writes the scenes of docs/formats.md, "Looks", as GLB into a folder:

    scripts/surface-scenes.py FOLDER

strips.glb (opacities 255, 170, 128, 64 and 0 in the three alpha modes before a blue board), materials.glb (balls:
roughness, metal, emitted light, unlit, blended) and cards.glb (a head of cards: brows, lashes, hair, glasses).
Nothing but Python's own library is needed."""

import json
import math
import struct
import sys
import zlib
from pathlib import Path


def png(width, height, pixel):
    rows = b"".join(
        b"\0" + b"".join(bytes(pixel(x, y)) for x in range(width)) for y in range(height)
    )
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


class Scene:
    def __init__(self):
        self.data = b""
        self.json = {
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
            "accessors": [], "bufferViews": [], "materials": [], "textures": [], "images": [],
            "extensionsUsed": ["KHR_materials_unlit"],
        }

    def view(self, data):
        self.data += b"\0" * (-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def accessor(self, values, kind):
        flat = [x for value in values for x in value] if kind != "SCALAR" else list(values)
        code, component = ("I", 5125) if kind == "SCALAR" else ("f", 5126)
        view = self.view(struct.pack(f"<{len(flat)}{code}", *flat))
        accessor = {"bufferView": view, "componentType": component, "count": len(values), "type": kind}
        if kind == "VEC3":
            accessor["min"] = [min(v[i] for v in values) for i in range(3)]
            accessor["max"] = [max(v[i] for v in values) for i in range(3)]
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def texture(self, picture):
        self.json["images"].append({"bufferView": self.view(picture), "mimeType": "image/png"})
        self.json["textures"].append({"source": len(self.json["images"]) - 1})
        return {"index": len(self.json["textures"]) - 1}

    def material(self, **material):
        self.json["materials"].append(material)
        return len(self.json["materials"]) - 1

    def part(self, name, mesh, material):
        positions, normals, uvs, triangles = mesh
        attributes = {
            "POSITION": self.accessor(positions, "VEC3"), "NORMAL": self.accessor(normals, "VEC3"),
            "TEXCOORD_0": self.accessor(uvs, "VEC2"),
        }
        indices = self.accessor([i for triangle in triangles for i in triangle], "SCALAR")
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        self.json["meshes"].append({"name": name, "primitives": [primitive]})
        self.json["nodes"].append({"name": name, "mesh": len(self.json["meshes"]) - 1})
        self.json["scenes"][0]["nodes"].append(len(self.json["nodes"]) - 1)

    def write(self, path):
        if not self.json["images"]:
            del self.json["images"], self.json["textures"]
        data = self.data + b"\0" * (-len(self.data) % 4)
        self.json["buffers"] = [{"byteLength": len(data)}]
        text = json.dumps(self.json).encode()
        text += b" " * (-len(text) % 4)
        total = 12 + 8 + len(text) + 8 + len(data)
        path.write_bytes(
            struct.pack("<4sII", b"glTF", 2, total) + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(data), b"BIN\0") + data)


def ball(center, radius, steps=32):
    positions, normals, uvs, triangles = [], [], [], []
    for row in range(steps + 1):
        for column in range(2 * steps + 1):
            yaw, polar = math.pi * column / steps, math.pi * row / steps
            n = (math.sin(polar) * math.sin(yaw), math.cos(polar), math.sin(polar) * math.cos(yaw))
            normals.append(n)
            positions.append(tuple(c + radius * x for c, x in zip(center, n)))
            uvs.append((column / (2 * steps), row / steps))
    across = 2 * steps + 1
    for row in range(steps):
        for column in range(2 * steps):
            a = row * across + column
            triangles += [(a, a + across, a + 1), (a + 1, a + across, a + across + 1)]
    return positions, normals, uvs, triangles


def grid(at, columns=1, rows=1):
    """A sheet: `at(u, v)` is its point, u to the right and v downward, seen from its front."""
    positions, normals, uvs, triangles = [], [], [], []
    for row in range(rows + 1):
        for column in range(columns + 1):
            u, v = column / columns, row / rows
            positions.append(at(u, v))
            e = 1e-3
            du = [b - a for a, b in zip(at(u - e, v), at(u + e, v))]
            dv = [b - a for a, b in zip(at(u, v + e), at(u, v - e))]
            n = (du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2], du[0] * dv[1] - du[1] * dv[0])
            length = math.hypot(*n) or 1.0
            normals.append(tuple(x / length for x in n))
            # Not up to the edge, where textures begin again.
            uvs.append((u, 0.02 + 0.96 * v))
    across = columns + 1
    for row in range(rows):
        for column in range(columns):
            a = row * across + column
            triangles += [(a, a + across, a + 1), (a + 1, a + across, a + across + 1)]
    return positions, normals, uvs, triangles


def board(x, y, z, half_width, half_height):
    return grid(lambda u, v: (x + (2 * u - 1) * half_width, y + (1 - 2 * v) * half_height, z))


def color(*rgba, **more):
    return {"baseColorFactor": list(rgba), "metallicFactor": 0.0, "roughnessFactor": 0.6} | more


def strips():
    scene = Scene()
    opacities = [255, 170, 128, 64, 0]
    texture = scene.texture(png(80, 16, lambda x, y: (230, 40, 30, opacities[x // 16])))
    blue = scene.material(name="blue", pbrMetallicRoughness=color(0.05, 0.1, 0.6, 1.0))
    scene.part("board", board(0.0, 0.0, -0.3, 2.2, 0.5), blue)
    for place, mode in enumerate(["OPAQUE", "MASK", "BLEND"]):
        look = color(1.0, 1.0, 1.0, 1.0, baseColorTexture=texture)
        material = scene.material(name=mode, alphaMode=mode, pbrMetallicRoughness=look)
        scene.part(mode, board(1.4 * (place - 1), 0.0, 0.0, 0.62, 0.62), material)
    return scene


def materials():
    scene = Scene()
    look = lambda **pbr: {"pbrMetallicRoughness": color(0.8, 0.45, 0.2, 1.0) | pbr}
    white = lambda x, y: (255, 255, 255, 255)
    checks = scene.texture(png(64, 32, lambda x, y: (0, 60 if (x // 8 + y // 8) % 2 else 200, 255, 255)))
    glow = scene.texture(png(64, 32, lambda x, y: white(x, y) if y // 4 % 2 else (0, 0, 0, 255)))
    rows = [
        [look(roughnessFactor=r) for r in (0.15, 0.4, 0.8)] + [look(roughnessFactor=0.35, metallicFactor=1.0)]
        + [look(roughnessFactor=1.0, metallicFactor=1.0, metallicRoughnessTexture=checks)],
        [
            look() | {"emissiveFactor": [0.1, 0.6, 0.9], "emissiveTexture": glow},
            look() | {"extensions": {"KHR_materials_unlit": {}}},
            {"pbrMetallicRoughness": color(0.2, 0.5, 0.9, 0.35, roughnessFactor=0.1), "alphaMode": "BLEND"},
            look(roughnessFactor=0.2, metallicFactor=1.0, baseColorFactor=[0.9, 0.9, 0.9, 1.0]),
            look(baseColorFactor=[0.05, 0.05, 0.05, 1.0], roughnessFactor=0.1),
        ],
    ]
    for row, looks in enumerate(rows):
        for column, look in enumerate(looks):
            material = scene.material(name=f"look {row} {column}", **look)
            scene.part(f"ball {row} {column}", ball((column - 2.0, 0.5 - row, 0.0), 0.44), material)
    return scene


def cards():
    scene = Scene()
    skin = scene.material(name="plain", pbrMetallicRoughness=color(0.75, 0.5, 0.4, 1.0))
    scene.part("base", ball((0.0, 0.0, 0.0), 1.0, 48), skin)

    def strand(width, count, seed, taper):
        """Strands that grow from the top of the picture and end at different lengths."""
        def pixel(x, y):
            lane = x * count // width
            middle = (lane + 0.5) * width / count
            wave = 1.5 * math.sin(y * 0.15 + lane * 1.7 + seed)
            half = 0.46 * width / count * (1.0 - taper * y / 64)
            length = 46 + (lane * 37 + seed * 11) % 18
            alpha = max(0.0, min(1.0, half - abs(x - middle - wave) + 0.5)) * max(0.0, min(1.0, (length - y) / 6))
            return 70 + 10 * (lane % 3), 42 + 6 * (lane % 3), 24, int(255 * alpha)
        return pixel

    hair_texture = scene.texture(png(64, 64, strand(64, 10, 1, 0.5)))
    brow_texture = scene.texture(png(64, 64, strand(64, 20, 3, 0.8)))
    look = color(1.0, 1.0, 1.0, 1.0, roughnessFactor=0.5)
    hair = scene.material(
        name="hair", alphaMode="BLEND", doubleSided=True,
        pbrMetallicRoughness=look | {"baseColorTexture": hair_texture})
    masked = scene.material(
        name="brow", alphaMode="MASK", alphaCutoff=0.4, doubleSided=True,
        pbrMetallicRoughness=look | {"baseColorTexture": brow_texture})
    on_ball = lambda yaw, pitch, r: (
        r * math.cos(pitch) * math.sin(yaw), r * math.sin(pitch), r * math.cos(pitch) * math.cos(yaw))
    white = scene.material(name="white", pbrMetallicRoughness=color(0.9, 0.9, 0.9, 1.0, roughnessFactor=0.1))
    dark = scene.material(name="dark", pbrMetallicRoughness=color(0.05, 0.03, 0.02, 1.0, roughnessFactor=0.1))
    for side in (-1, 1):
        scene.part(f"ball {side}", ball((0.33 * side, 0.1, 0.86), 0.17), white)
        scene.part(f"iris {side}", ball((0.33 * side, 0.1, 0.95), 0.1), dark)
        # Brows and lashes stand on the skin.
        scene.part(f"brow {side}", grid(
            lambda u, v: on_ball(side * 0.34 + (u - 0.5) * 0.42, 0.42 + 0.14 * (0.5 - v) - 0.1 * (u - 0.5) ** 2, 1.03),
            8, 2), masked)
        scene.part(f"lash {side}", grid(
            lambda u, v: on_ball(side * 0.34 + (u - 0.5) * 0.4, 0.2 + 0.1 * v - 0.5 * (u - 0.5) ** 2, 1.04 + 0.12 * v),
            8, 2), masked)
    # Three layers of cards from the crown, one over the other.
    for layer in range(3):
        for card in range(14):
            middle = math.pi + (card + 0.5 * layer - 6.5) * 0.36
            scene.part(f"hair {layer} {card}", grid(
                lambda u, v: on_ball(
                    middle + (u - 0.5) * 0.5, 1.45 - v * 1.5, 1.04 + 0.03 * layer + 0.06 * v),
                4, 8), hair)
    frame = scene.material(name="frame", pbrMetallicRoughness=color(0.02, 0.02, 0.02, 1.0, roughnessFactor=0.3))
    glass = scene.material(
        name="glass", alphaMode="BLEND", doubleSided=True,
        pbrMetallicRoughness=color(0.2, 0.5, 0.8, 0.3, roughnessFactor=0.05))
    for side in (-1, 1):
        disk = lambda r, u, v: (
            0.36 * side + r * math.cos(2 * math.pi * u), 0.1 + r * math.sin(-2 * math.pi * u), 1.22)
        scene.part(f"glass {side}", grid(lambda u, v: disk(0.25 * (1 - v), u, v), 32, 1), glass)
        scene.part(f"frame {side}", grid(
            lambda u, v: tuple(
                a + b for a, b in zip(disk(0.25 + 0.025 * math.cos(2 * math.pi * v), u, v),
                                      (0.0, 0.0, 0.025 * math.sin(2 * math.pi * v)))), 32, 8), frame)
    return scene


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, scene in (("strips", strips()), ("materials", materials()), ("cards", cards())):
        scene.write(folder / f"{name}.glb")


if __name__ == "__main__":
    main()
