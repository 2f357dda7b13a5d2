//! Diagnostics of meshes: E40 reading their files, E41 the gate and the cut into tubes; W42 and N43 remarks on them.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! mesh {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// The file is of another format, cut off, or broken.
///
/// The message says where: the line, the facet, or what the file claims to hold and does not.
///
/// Wrong: a binary STL file that claims a billion triangles in 100 bytes
/// Right: the same mesh, exported again.
MeshSyntax = "E4001", "a mesh file cannot be read";
/// A face names a vertex that is not there.
///
/// Vertices of OBJ files count from 1, in order of the file; negative numbers count back from the last one.
///
/// Wrong: `f 1 2 9` in a file with 8 vertices
/// Right: `f 1 2 8`
MeshIndex = "E4002", "a face names a vertex that is not there";
/// A coordinate is not a number, infinite, or too large to compute with.
///
/// Wrong: `v nan 0 1`
/// Right: `v 0.5 0 1`
MeshNumber = "E4003", "a coordinate is no usable number";
/// The mesh has no faces, or none with an area.
///
/// Point clouds and curves have no surface to work on.
///
/// Wrong: an export of points only, or of an object whose faces were deleted
/// Right: an export of the object with its faces.
MeshEmpty = "E4004", "a mesh without faces";
/// A mesh with more vertices or triangles than Picot reads.
///
/// Stitches are millimeters wide, so triangles much finer than that show nothing. Simplify the mesh.
///
/// Wrong: a scan with 50 million triangles for a toy of 3000 stitches
/// Right: the same with 100,000 triangles; in Blender: modifier Decimate.
MeshTooLarge = "E4005", "a mesh is too large";
/// A file of loops has a line that is none of its format, or too few loops. `grammar/loops.ebnf` has the format.
///
/// Its first line is `picot-loops 1`; each loop begins with a line `loop`, and has a point on each further line.
///
/// Wrong: `loop 1 2 3`
/// Right: `loop`, and on the next line `1 2 3`
LoopsSyntax = "E4006", "a file of loops cannot be read";
/// The faces form no surface: an edge has more than two faces, or parts touch in a single point.
///
/// Inner walls and doubled faces do this, often left over from a union of two objects.
///
/// Wrong: two boxes that share an edge
/// Right: one outer skin; in Blender: Select > All by Trait > Non Manifold shows the places.
NotManifold = "E4101", "the faces form no surface";
/// The mesh is in several pieces that do not touch.
///
/// One pattern makes one object. Eyes and buttons lie apart in many models.
///
/// Wrong: a body and two loose eyes in one file
/// Right: each in a file of its own, or united to one skin (in Blender: modifier Boolean > Union).
MeshPieces = "E4102", "a mesh in several pieces";
/// The surface has one side only, like a Möbius strip.
///
/// A fabric has a right side and a wrong side.
///
/// Wrong: a strip closed with a half twist
/// Right: a strip closed without a twist, or with a full one.
OneSided = "E4103", "the surface has one side only";
/// The surface has a handle, like a torus or a mug.
///
/// A tube is worked from one end to the other and never comes back to itself. The message says where the handle is.
///
/// Wrong: a mug with its handle
/// Right: the mug without it, and the handle as a piece of its own, sewn on.
MeshHandle = "E4104", "the surface has a handle";
/// The surface has a hole that is no end of a tube, or one too small to work from.
///
/// Openings are fine where a tube ends: the top of a hat, the legs of trousers. A hole in the middle of a flat piece is
/// not, unless a shape file names it in `start` or `poles`.
///
/// Wrong: a ball with one face missing
/// Right: the ball closed; in Blender: select the edge and Face > Fill.
MeshHole = "E4105", "the surface has a hole";
/// No rows can be laid on the mesh.
///
/// It has only one end, or a limb is too short for its stitches.
///
/// Wrong: `poles` that name nothing but the start
/// Right: `poles` with a point on every tip, or no `poles` at all.
MeshUnworkable = "E4106", "no rows can be laid on the mesh";
/// Two loops of a stack cross each other, or run around the tube in opposite directions.
///
/// Rows are laid from loop to loop, so each loop lies behind the one before it, all the way around.
///
/// Wrong: a loop tilted so far that one side of it lies in front of the one before
/// Right: loops across the tube, a little apart on the inner side of a bend, too.
LoopsCross = "E4107", "loops cross each other";
/// A limb has fewer than three rounds and is worked as a bulge of what it grows from.
///
/// Short rows follow the bulge. With a smaller stitch it becomes a part of its own.
///
/// Dropped: an ear of 8 mm in stitches of 5 mm
/// Kept: the same ear in stitches of 2.5 mm.
LimbDropped = "W4201", "a limb is too short to be a part";
/// The mesh was repaired before it was cut; its shape is the same.
///
/// Vertices in the same place are welded, faces without an area or standing twice are dropped, and faces are turned so
/// that all of them look outward.
///
/// Repaired: a face with two corners in the same place
/// Refused: a hole, an inner wall, two pieces.
MeshRepaired = "N4301", "the mesh was repaired";
/// Where rows begin and end on a mesh, as Picot chose.
///
/// Open edges and the tips of limbs are ends; the broadest of them is the start, and of several the lowest. The words of
/// the message can be written into the `[mesh]` of a shape file and changed there.
///
/// Chosen: start = [0, 0, -4] to poles = [[0, 0, 6]]
/// Changed: `[mesh]` with `start = [0, 0, 6]`
MeshEnds = "N4302", "where rows begin and end";
        }
    };
}
pub(super) use mesh;
