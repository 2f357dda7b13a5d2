"""Planar sections of a triangle mesh along a curve: plain Python, no Blender needed."""

from math import acos, atan2, pi, sqrt


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def scaled(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def norm(a):
    return sqrt(dot(a, a))


def unit(a):
    length = norm(a)
    return scaled(a, 1.0 / length) if length > 0.0 else a


class SliceError(Exception):
    """The mesh cannot be sliced along this curve; the message says where."""


def stations(points, step):
    """Points and unit tangents along a polyline, about `step` apart, evenly spread."""
    if len(points) < 2:
        raise SliceError("the curve needs at least two points")
    lengths = [0.0]
    for a, b in zip(points, points[1:]):
        lengths.append(lengths[-1] + norm(sub(b, a)))
    total = lengths[-1]
    if total <= 0.0 or step <= 0.0:
        raise SliceError("the curve has no length")
    tangents = []
    for i in range(len(points)):
        before, after = points[max(i - 1, 0)], points[min(i + 1, len(points) - 1)]
        tangents.append(unit(sub(after, before)))
    count = max(2, round(total / step))
    out = []
    segment = 0
    for k in range(count + 1):
        # The ends lie a hair inside, where a section can be.
        at = total * min(max(k / count, 1e-6), 1.0 - 1e-6)
        while segment + 2 < len(lengths) and lengths[segment + 1] < at:
            segment += 1
        span = lengths[segment + 1] - lengths[segment]
        t = (at - lengths[segment]) / span if span > 0.0 else 0.0
        a, b = points[segment], points[segment + 1]
        point = add(a, scaled(sub(b, a), t))
        tangent = unit(add(scaled(tangents[segment], 1.0 - t), scaled(tangents[segment + 1], t)))
        out.append((point, tangent))
    return out


def section(vertices, triangles, origin, normal):
    """Closed lines in which a plane cuts the mesh."""
    side = [dot(sub(v, origin), normal) for v in vertices]
    next_edge = {}
    place = {}

    def crossing(a, b):
        key = (a, b) if a < b else (b, a)
        if key not in place:
            low, high = key
            t = side[low] / (side[low] - side[high])
            place[key] = add(vertices[low], scaled(sub(vertices[high], vertices[low]), t))
        return key

    for face in triangles:
        above = [side[v] >= 0.0 for v in face]
        if all(above) or not any(above):
            continue
        enter = leave = None
        for k in range(3):
            a, b = face[k], face[(k + 1) % 3]
            if side[a] < 0.0 <= side[b]:
                enter = crossing(a, b)
            elif side[b] < 0.0 <= side[a]:
                leave = crossing(a, b)
        next_edge[enter] = leave
    loops = []
    while next_edge:
        first, at = next_edge.popitem()
        keys = [first]
        while at != first and at in next_edge:
            keys.append(at)
            at = next_edge.pop(at)
        if at == first and len(keys) >= 3:
            loops.append([place[key] for key in keys])
    return loops


def turns(loop, origin, axis):
    """How often a loop runs around an axis."""
    helper = (1.0, 0.0, 0.0) if abs(axis[0]) < 0.9 else (0.0, 1.0, 0.0)
    first = unit(cross(axis, helper))
    second = cross(axis, first)
    flat = [(dot(sub(p, origin), first), dot(sub(p, origin), second)) for p in loop]
    total = 0.0
    for a, b in zip(flat, flat[1:] + flat[:1]):
        total += atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1])
    return round(total / (2.0 * pi))


def around(vertices, triangles, origin, normal):
    """The section that runs around a point, the nearest of several; clockwise seen from the end. None without one."""
    best = None
    for loop in section(vertices, triangles, origin, normal):
        count = turns(loop, origin, normal)
        if count == 0:
            continue
        near = min(norm(sub(p, origin)) for p in loop)
        if best is None or near < best[0]:
            best = (near, loop if count < 0 else loop[::-1])
    return best[1] if best else None


def length(loop):
    return sum(norm(sub(b, a)) for a, b in zip(loop, loop[1:] + loop[:1]))


def tilt(a, b):
    """Angle between two directions."""
    return acos(max(-1.0, min(1.0, dot(a, b))))


def apex(vertices, loop, origin, outward):
    """The farthest vertex beyond an end of a curve, beside the loop around it."""
    reach = length(loop) / pi
    beyond = [v for v in vertices if norm(sub(v, origin)) < reach and dot(sub(v, origin), outward) > 0.0]
    return max(beyond, key=lambda v: dot(sub(v, origin), outward), default=None)


def cut(vertices, triangles, curve, step, shut):
    """Loops along a curve, about `step` apart, and the points that close the start and the end.

    An end with a loop shorter than `shut` is closed in a point: the farthest vertex beyond it.
    """
    loops, places, missed = [], [], None
    for point, tangent in stations(curve, step):
        loop = around(vertices, triangles, point, tangent)
        if loop is None:
            if loops and missed is None:
                missed = point
            continue
        if missed is not None:
            raise SliceError("no section runs around the curve at (%.3g, %.3g, %.3g)" % missed)
        if places and tilt(places[-1][1], tangent) > pi / 3.0:
            raise SliceError("the curve bends too sharply at (%.3g, %.3g, %.3g)" % point)
        loops.append(loop)
        places.append((point, tangent))
    if len(loops) < 2:
        raise SliceError("the curve does not run through the mesh: fewer than two sections run around it")
    poles = [None, None]
    for side, sign in ((0, -1.0), (1, 1.0)):
        loop, (point, tangent) = loops[-side], places[-side]
        if length(loop) < shut:
            poles[side] = apex(vertices, loop, point, scaled(tangent, sign)) or point
    return loops, poles


def text(name, loops, poles, unit_word="mm", gauge=None):
    """Loops in the text format that Picot reads (grammar/loops.ebnf)."""
    name = "".join(c for c in name if c.isprintable() and c != "#")
    lines = ["picot-loops 1", "name " + name, "unit " + unit_word]
    if gauge:
        lines.append("gauge %.6g %.6g" % gauge)
    for word, pole in zip(("start", "end"), poles):
        if pole:
            lines.append("%s %.6f %.6f %.6f" % ((word,) + tuple(pole)))
    for loop in loops:
        lines.append("loop")
        lines.extend("%.6f %.6f %.6f" % tuple(p) for p in loop)
    return "\n".join(lines) + "\n"
