"""Exports a bent capsule through bpy and compares its pattern with that of the same capsule as a shape file.

Usage: python test_export.py PICOT. Exits with 77 when there is no bpy.
"""

import json
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

try:
    import bpy
except ImportError:
    print("skipped: no bpy module")
    sys.exit(77)

import picot_export

STITCH = 4.0
# In centimeters: one cubic Bezier segment that bends by 90 degrees.
AXIS = [(0.0, 0.0, 0.0), (0.0, 0.0, 4.0), (2.0, 0.0, 8.0), (8.0, 0.0, 8.0)]
RADIUS = 1.5


def bezier(t):
    s = 1.0 - t
    weights = (s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t)
    return tuple(sum(w * p[k] for w, p in zip(weights, AXIS)) for k in range(3))


def tangent(t):
    s = 1.0 - t
    legs = [tuple(b[k] - a[k] for k in range(3)) for a, b in zip(AXIS, AXIS[1:])]
    weights = (3 * s * s, 6 * s * t, 3 * t * t)
    way = tuple(sum(w * leg[k] for w, leg in zip(weights, legs)) for k in range(3))
    size = math.sqrt(sum(x * x for x in way))
    return tuple(x / size for x in way)


def radius(t):
    """Round at both ends: 0 at the poles, full from 0.15 to 0.85."""
    edge = min(t, 1.0 - t) / 0.15
    return RADIUS * (1.0 if edge >= 1.0 else math.sqrt(edge * (2.0 - edge)))


def capsule(rows=160, around=64):
    """The capsule as vertices and faces, counterclockwise seen from outside."""
    vertices, faces = [bezier(0.0)], []
    for i in range(1, rows):
        t = i / rows
        center, way = bezier(t), tangent(t)
        side = (0.0, 1.0, 0.0)
        other = (way[1] * side[2] - way[2] * side[1], way[2] * side[0] - way[0] * side[2], way[0] * side[1] - way[1] * side[0])
        for k in range(around):
            c, s = math.cos(2 * math.pi * k / around), math.sin(2 * math.pi * k / around)
            vertices.append(tuple(center[j] + radius(t) * (c * side[j] + s * other[j]) for j in range(3)))
    vertices.append(bezier(1.0))
    last = len(vertices) - 1
    at = lambda i, k: 1 + i * around + k % around
    for k in range(around):
        faces.append((0, at(0, k), at(0, k + 1)))
        faces.append((last, at(rows - 2, k + 1), at(rows - 2, k)))
        for i in range(rows - 2):
            faces.append((at(i, k), at(i + 1, k), at(i + 1, k + 1), at(i, k + 1)))
    return vertices, faces


def shape_file():
    sections = ["  { at = %.4f, circle = %.6f }," % (t, max(radius(t), 1e-4)) for t in (i / 100 for i in range(1, 100))]
    return "\n".join(
        [
            'name = "bent capsule"',
            'unit = "cm"',
            "[gauge]",
            "stitch = { width = %g, height = %g }" % (STITCH / 10, STITCH / 10),
            "[trunk]",
            "curve = %s" % [list(p) for p in AXIS],
            'start = "closed"',
            'end = "closed"',
            "section = [",
            "  { at = 0, circle = 0 },",
            *sections,
            "  { at = 1, circle = 0 },",
            "]",
            "",
        ]
    )


def counts(picot, path):
    """Loops that each round makes."""
    run = subprocess.run([picot, "-q", "build", str(path), "--to", "json"], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit("%s: %s" % (path, run.stderr))
    part = json.loads(run.stdout)["parts"][0]
    return [sum(step["times"] for step in r["steps"] if "times" in step) for r in part["rounds"]]


def scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    vertices, faces = capsule()
    mesh = bpy.data.meshes.new("bent capsule")
    mesh.from_pydata(vertices, [], faces)
    mesh.validate()
    body = bpy.data.objects.new("bent capsule", mesh)
    curve = bpy.data.curves.new("axis", "CURVE")
    curve.dimensions, curve.resolution_u = "3D", 64
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(1)
    for point, (here, left, right) in zip(
        spline.bezier_points,
        ((AXIS[0], AXIS[0], AXIS[1]), (AXIS[3], AXIS[2], AXIS[3])),
    ):
        point.handle_left_type = point.handle_right_type = "FREE"
        point.co, point.handle_left, point.handle_right = here, left, right
    axis = bpy.data.objects.new("axis", curve)
    for obj in (body, axis):
        bpy.context.scene.collection.objects.link(obj)
        obj.select_set(True)
    bpy.context.view_layer.objects.active = body
    bpy.context.view_layer.update()


def main():
    picot = sys.argv[1]
    picot_export.register()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        scene()
        loops = folder / "capsule.loops"
        result = bpy.ops.export_scene.picot_loops(filepath=str(loops), stitch=STITCH, scale=10.0)
        assert result == {"FINISHED"}, result
        shape = folder / "capsule.toml"
        shape.write_text(shape_file())
        one, other = counts(picot, shape), counts(picot, loops)
        total, sum_ = sum(one), sum(other)
        print("shape file: %d rounds, %d stitches" % (len(one), total))
        print("export:     %d rounds, %d stitches" % (len(other), sum_))
        assert abs(sum_ - total) <= 0.02 * total, "stitches differ by more than 2 %"
        assert abs(len(one) - len(other)) <= max(1, 0.02 * len(one)), "rounds differ"
        # Without a mesh it refuses in words.
        bpy.context.view_layer.objects.active = None
        try:
            bpy.ops.export_scene.picot_loops(filepath=str(loops), stitch=STITCH, scale=10.0)
        except RuntimeError as error:
            assert "no mesh" in str(error), error
        else:
            raise SystemExit("an export without a mesh went through")
    picot_export.unregister()
    print("the export agrees with the shape file")


if __name__ == "__main__":
    main()
