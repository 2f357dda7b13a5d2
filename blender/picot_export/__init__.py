"""Blender add-on: slices the active mesh along a curve and exports the sections for Picot.

Select the mesh, add a curve to the selection that runs through its inside from end to end, and choose
File > Export > Picot loops. Without a selected curve the mesh's own longest axis is taken.
"""

import bpy
from bpy.props import FloatProperty, StringProperty
from bpy_extras.io_utils import ExportHelper

from . import slicing

bl_info = {
    "name": "Picot loops",
    "author": "the Picot authors",
    "version": (1, 0, 0),
    "blender": (4, 2, 0),
    "location": "File > Export > Picot loops (.loops)",
    "description": "Slices the active mesh along a curve for crochet and knitting patterns",
    "category": "Import-Export",
}


def triangles_of(obj, depsgraph):
    """World coordinates and triangles of a mesh object, modifiers applied."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        mesh.calc_loop_triangles()
        matrix = obj.matrix_world
        vertices = [tuple(matrix @ vertex.co) for vertex in mesh.vertices]
        faces = [tuple(triangle.vertices) for triangle in mesh.loop_triangles]
        if matrix.determinant() < 0.0:
            faces = [face[::-1] for face in faces]
        return vertices, faces
    finally:
        evaluated.to_mesh_clear()


def polyline_of(obj, depsgraph):
    """Points of the first spline of a curve object in world coordinates, as finely as Blender draws it."""
    evaluated = obj.evaluated_get(depsgraph)
    mesh = evaluated.to_mesh()
    try:
        neighbors = {}
        for edge in mesh.edges:
            a, b = edge.vertices
            neighbors.setdefault(a, []).append(b)
            neighbors.setdefault(b, []).append(a)
        ends = sorted(v for v, list_ in neighbors.items() if len(list_) == 1)
        if not ends:
            raise slicing.SliceError("the curve has no ends: it must run from one end of the mesh to the other")
        at, before, chain = ends[0], None, []
        while at is not None:
            chain.append(at)
            following = [v for v in neighbors[at] if v != before]
            before, at = at, following[0] if following else None
        return [tuple(obj.matrix_world @ mesh.vertices[v].co) for v in chain]
    finally:
        evaluated.to_mesh_clear()


def axis_of(vertices):
    """A straight line through the middle of a mesh along its longest axis."""
    low = [min(v[k] for v in vertices) for k in range(3)]
    high = [max(v[k] for v in vertices) for k in range(3)]
    middle = [0.5 * (a + b) for a, b in zip(low, high)]
    longest = max(range(3), key=lambda k: high[k] - low[k])
    start, end = list(middle), list(middle)
    start[longest], end[longest] = low[longest], high[longest]
    return [tuple(start), tuple(end)]


def export(context, filepath, stitch, scale):
    """Slices the active mesh and writes the file. Returns the number of loops."""
    obj = context.view_layer.objects.active
    if obj is None or obj.type != "MESH":
        raise slicing.SliceError("the active object is no mesh")
    depsgraph = context.evaluated_depsgraph_get()
    vertices, faces = triangles_of(obj, depsgraph)
    if not faces:
        raise slicing.SliceError("the mesh has no faces")
    curves = [o for o in context.view_layer.objects if o.type == "CURVE" and o.select_get()]
    if len(curves) > 1:
        raise slicing.SliceError("%d curves are selected; select one" % len(curves))
    curve = polyline_of(curves[0], depsgraph) if curves else axis_of(vertices)
    millimeters = lambda points: [slicing.scaled(p, scale) for p in points]
    loops, poles = slicing.cut(
        millimeters(vertices), faces, millimeters(curve), 0.5 * stitch, shut=9.0 * stitch
    )
    with open(filepath, "w", encoding="utf-8", newline="\n") as file:
        file.write(slicing.text(obj.name, loops, poles, "mm", (stitch, stitch)))
    return len(loops)


class EXPORT_OT_picot_loops(bpy.types.Operator, ExportHelper):
    """Slice the active mesh along the selected curve and write the sections for Picot"""

    bl_idname = "export_scene.picot_loops"
    bl_label = "Export Picot loops"

    filename_ext = ".loops"
    filter_glob: StringProperty(default="*.loops", options={"HIDDEN"})
    stitch: FloatProperty(name="Stitch size (mm)", default=5.0, min=0.5, max=100.0)
    scale: FloatProperty(
        name="Millimeters per unit", description="Length of a Blender unit", default=10.0, min=1e-6, max=1e6
    )

    def execute(self, context):
        try:
            count = export(context, self.filepath, self.stitch, self.scale)
        except slicing.SliceError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        except OSError as error:
            self.report({"ERROR"}, "the file cannot be written: %s" % error)
            return {"CANCELLED"}
        self.report({"INFO"}, "%d loops written" % count)
        return {"FINISHED"}


def menu(self, _context):
    self.layout.operator(EXPORT_OT_picot_loops.bl_idname, text="Picot loops (.loops)")


def register():
    bpy.utils.register_class(EXPORT_OT_picot_loops)
    bpy.types.TOPBAR_MT_file_export.append(menu)


def unregister():
    bpy.types.TOPBAR_MT_file_export.remove(menu)
    bpy.utils.unregister_class(EXPORT_OT_picot_loops)
