//! Diagnostics of shapes and of what is made of them: E10 shape files, E11 the geometry of a shape, E13 and W13 the generator; W12 and N12 remarks on shapes.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! shape {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// An option of the generator is out of its range.
///
/// Wrong: `--set max-short-row=2`. Right: `--set max-short-row=0.5`.
/// `picot build --help` names the options; the message names the range.
OptionOutOfRange = "E1301", "an option is out of range";
/// The tube is too short for its stitch: not even one round can be worked.
///
/// A tube needs at least two rows from end to end, a closed end half a row more.
///
/// Wrong: a tube 3 mm long with stitches 5 mm high.
/// Right: a smaller stitch, or a longer tube.
TooFewRows = "E1302", "too few rows";
/// The surface cannot be covered: it folds over itself, jumps, or has no finite size.
///
/// Rows are laid at equal distance along the surface. Where it bends more sharply than its own radius allows, or where
/// neighboring sections differ by far more than a row can follow, stitches run away.
///
/// Wrong: a tube of radius 3 around a bend of radius 1.
/// Right: a wider bend, or a thinner tube.
SurfaceBroken = "E1303", "the surface cannot be covered";
/// Stitches lean so much that a part turns by three quarters of a turn or more over its length.
///
/// `lean` says by how many stitches a column moves in each round of one maker, positive in working direction. Rarely is it
/// more than a tenth. A pattern for a wrong lean comes out twisted.
///
/// Wrong: `--set lean=0.8` where a column moved by 0.8 stitches over 20 rounds. Right: `--set lean=0.04`.
MuchLean = "W1306", "stitches lean much";
/// A tube is thinner than five stitches around, and is made thicker.
///
/// Fewer stitches than five do not make a round that can be worked: the tip of a spike, a very thin neck or a tube like a cord
/// comes out as thick as five stitches are. For something thinner make a cord, or use a thinner yarn.
///
/// Wrong: a tail of 4 mm radius with stitches 6 mm wide
/// Right: stitches at most 5 mm wide for this tail
MadeThicker = "W1307", "a tube is made thicker than asked for";
/// There are no stitches where a branch is joined.
///
/// Each first loop of a branch is worked into the nearest stitch of its parent; for a slit, a run of stitches of one
/// round is held. Very near to an end, or where stitches are large against the branch, there may be none.
///
/// Wrong: an arm of four stitches around that leaves one row below the top of its trunk
/// Right: the arm a few rows lower, or a smaller stitch
JoinMissesStitches = "E1304", "no stitches to join a branch to";
/// A part divides into others in a way that is not made.
///
/// The last loop of a part can divide between two others, as a pair of trousers does: with `join = "split"` and `from = 1`
/// in a shape file, or where a mesh forks evenly. Each of the two begins beside the middle of that loop, on its own side,
/// and gets at least three of its stitches.
///
/// Wrong: one leg with `join = "split"`, or three
/// Right: two legs with `join = "split"`, either of which may divide again
DividesOddly = "E1305", "a part divides in a way that is not made";
/// The file is not TOML.
///
/// Shape files are written in TOML: `key = value` lines under `[table]` headers, texts in quotes, lists in brackets.
///
/// Wrong: `unit = cm`
/// Right: `unit = "cm"`
TomlSyntax = "E1001", "the file is not TOML";
/// A key that a shape file does not know, often a slip of the finger.
///
/// Nothing is skipped in silence: a misspelled key would change the object. The keys are listed in `grammar/shape.md`.
///
/// Wrong: `sections = [{ at = 0, circle = 1 }]`
/// Right: `section = [{ at = 0, circle = 1 }]`
UnknownKey = "E1002", "unknown key";
/// A key that must be there is missing.
///
/// A shape file needs `[gauge]` and `[trunk]`; a trunk needs `curve` and `section`; a section needs `at`.
///
/// Wrong: `section = [{ circle = 1 }]`
/// Right: `section = [{ at = 0, circle = 1 }]`
MissingKey = "E1003", "a key is missing";
/// A value has another type than the key takes.
///
/// Numbers stand without quotes and without a unit: the unit of all lengths is the file's `unit`.
///
/// Wrong: `circle = "2 cm"`
/// Right: `circle = 2`
WrongType = "E1004", "a value of the wrong type";
/// A word that is none of those that the key takes.
///
/// `unit` is mm, cm or in; `start` and `end` are open or closed; `interpolation` is linear or smooth.
///
/// Wrong: `end = "close"`
/// Right: `end = "closed"`
UnknownWord = "E1005", "not one of the possible words";
/// A number that is no size: not a number, infinite, or beyond 10 km.
///
/// Wrong: `circle = nan`
/// Right: `circle = 1.5`
BadNumber = "E1006", "not a usable number";
/// The file does not say how large a stitch is.
///
/// The same shape takes other stitches in other yarn, so a gauge is needed, in one of three ways: measured on a
/// swatch (best), as the size of a stitch, or as yarn and hook (an estimate).
///
/// Wrong: no `[gauge]`, or an empty one.
/// Right: `[gauge]` and `swatch = { width = 6, height = 5.5, stitches = 10, rows = 10 }`
GaugeMissing = "E1007", "the gauge is missing";
/// The gauge is given in more than one way.
///
/// `stitch`, `swatch` and `yarn` each say how large a stitch is; two of them may disagree.
///
/// Wrong: `stitch = { width = 0.6, height = 0.55 }` and `yarn = { weight = 4, hook = "5 mm" }`
/// Right: one of the two.
GaugeConflict = "E1008", "the gauge is given more than once";
/// A section has no profile, or more than one.
///
/// A section is a `circle` with a radius, an `ellipse` with two, or a `loop` of points.
///
/// Wrong: `{ at = 0, circle = 1, ellipse = [1, 2] }`
/// Right: `{ at = 0, ellipse = [1, 2] }`
SectionForm = "E1009", "a section needs exactly one profile";
/// A point has too few or too many numbers.
///
/// Points of a curve have three numbers, those of a loop two or three, an `offset` or an `ellipse` two.
///
/// Wrong: `curve = [[0, 0], [0, 10]]`
/// Right: `curve = [[0, 0, 0], [0, 0, 10]]`
PointForm = "E1010", "a point with the wrong number of coordinates";
/// A curve segment has one point only, or more than four.
///
/// Two points are a straight line, three a quadratic, four a cubic Bézier segment. A longer curve is a list of
/// segments, each starting where the one before ends.
///
/// Wrong: `curve = [[0, 0, 0], [0, 0, 1], [0, 0, 2], [0, 0, 3], [0, 0, 4]]`
/// Right: `curve = [[[0, 0, 0], [0, 0, 2]], [[0, 0, 2], [0, 0, 4]]]`
CurveDegree = "E1011", "a curve segment has 2 to 4 points";
/// A key or a table is given twice.
///
/// Two `[gauge]` tables, or two `curve` lines in one table, leave open which is meant.
///
/// Wrong: `unit = "cm"` and further down `unit = "mm"`
/// Right: one of the two.
DuplicateKey = "E1012", "a key is given twice";
/// A branch does not begin where it says.
///
/// `from` is a place on the curve of the parent, 0 at its start and 1 at its end, and the curve of the branch begins
/// there, in the coordinates of the file. It may begin on the parent's curve or anywhere up to its surface; what lies
/// inside of the parent is cut off. A branch begins on its parent, so it does not start closed.
///
/// Wrong: `from = 12` or, on a trunk from `[0, 0, 0]` to `[0, 0, 10]`, `from = 0.5` with `curve = [[0, 0, 0], [4, 0, 0]]`
/// Right: `from = 0.5` with `curve = [[0, 0, 5], [4, 0, 5]]`
BranchStart = "E1020", "a branch does not begin where it says";
/// A branch names a part to grow from that is not there, or that grows from the branch itself.
///
/// `on` names another branch. Without it a branch grows from the trunk.
///
/// Wrong: `name = "thumb"` with `on = "hnad"`
/// Right: `on = "hand"`, with a `[[branch]]` that has `name = "hand"`
NoParent = "E1021", "no part to grow from";
/// Two parts have one name.
///
/// Names are told apart without regard to capitals, and the name of the trunk is `trunk`.
///
/// Wrong: two branches with `name = "leg"`
/// Right: `name = "left leg"` and `name = "right leg"`
PartNameTwice = "E1022", "two parts have one name";
/// A list is empty where something is needed.
///
/// Wrong: `section = []`
/// Right: `section = [{ at = 0, circle = 1 }]`
EmptyList = "E1015", "a list is empty";
/// A yarn weight that the standard does not know.
///
/// Weights are 0 to 7 or their names: lace, super fine, fine, light, medium, bulky, super bulky, jumbo, and common
/// other names such as sock, sport, dk, worsted, aran, chunky. Most labels show the number.
///
/// Wrong: `weight = "worstd"`
/// Right: `weight = "worsted"` or `weight = 4`
UnknownYarn = "E1016", "unknown yarn weight";
/// A hook size that is neither millimeters nor a US size.
///
/// A bare number is refused: 8 is a hook of 8 mm, or a US size of 5 mm.
///
/// Wrong: `hook = 8`
/// Right: `hook = "8 mm"`, `hook = "H-8"` or `hook = "US 8"`
UnknownHook = "E1017", "unknown hook size";
/// A list has more entries than Picot reads.
///
/// The caps keep memory and time in bounds for any input: 2048 segments, 1024 sections, 10,000 points of a loop.
///
/// Wrong: a `loop` of a million points for one round of 60 stitches.
/// Right: a `loop` of 100 points.
TooManyEntries = "E1018", "a list is too long";
/// A name that cannot stand in a pattern.
///
/// The name becomes the title of the pattern, so it is one line of text.
///
/// Wrong: `name = ""`
/// Right: `name = "Bear's ear"`
BadName = "E1019", "not a usable name";
/// A size is zero or negative.
///
/// Radii and stitch sizes are above zero. Only at a closed end a section may shrink to a point.
///
/// Wrong: `{ at = 1, circle = 0 }` with an open end
/// Right: the same with `end = "closed"`
SizeNotPositive = "E1101", "a size must be above zero";
/// A stitch that can hardly be made: below 0.2 mm or above 100 mm. Mostly the unit is another one.
///
/// Wrong: `unit = "mm"` and `stitch = { width = 0.06, height = 0.055 }`
/// Right: `unit = "cm"` and `stitch = { width = 0.6, height = 0.55 }`
StitchSize = "E1102", "an impossible stitch size";
/// A section lies outside of the curve.
///
/// `at` is the curve parameter from 0 to 1, not a length.
///
/// Wrong: `{ at = 12, circle = 1 }`
/// Right: `{ at = 1, circle = 1 }`
SectionPlace = "E1103", "a section lies outside of the curve";
/// Sections are not listed from the start of the curve to its end, or two lie at the same place.
///
/// Wrong: `section = [{ at = 1, circle = 1 }, { at = 0, circle = 2 }]`
/// Right: `section = [{ at = 0, circle = 2 }, { at = 1, circle = 1 }]`
SectionOrder = "E1104", "sections are out of order";
/// A loop of points does not run around once.
///
/// The points of a loop go around the tube in order, without crossing, and the loop is closed by itself.
///
/// Wrong: `loop = [[1, 0], [-1, 0], [0, 1], [0, -1]]`, which crosses itself
/// Right: `loop = [[1, 0], [0, 1], [-1, 0], [0, -1]]`
SectionLoop = "E1105", "a loop does not run around once";
/// All points of a curve segment are the same, so it has no direction.
///
/// Wrong: `curve = [[0, 0, 0], [0, 0, 0]]`
/// Right: `curve = [[0, 0, 0], [0, 0, 10]]`
SegmentLength = "E1106", "a curve segment has no length";
/// A curve segment does not start where the one before ends.
///
/// Wrong: `curve = [[[0, 0, 0], [0, 0, 4]], [[0, 0, 5], [0, 0, 9]]]`
/// Right: `curve = [[[0, 0, 0], [0, 0, 4]], [[0, 0, 4], [0, 0, 9]]]`
CurveGap = "E1107", "curve segments do not meet";
/// The curve has a corner, or turns back on the spot.
///
/// A tube cannot follow a corner: the last two points of a segment and the first two of the next lie in one line.
///
/// Wrong: `curve = [[[0, 0, 0], [0, 0, 5]], [[0, 0, 5], [5, 0, 5]]]`
/// Right: `curve = [[0, 0, 0], [0, 0, 5], [5, 0, 5]]`, which rounds the corner
CurveKink = "E1108", "the curve has a corner";
/// The curve bends so tightly that the tube folds into itself on the inner side.
///
/// Curvature x radius must stay below 1: the bend is wider than the tube.
///
/// Wrong: a tube of radius 3 along `curve = [[0, 0, 0], [0, 0, 4], [4, 0, 4]]`
/// Right: radius 1 along it, or a curve twice as wide.
CurveTooTight = "E1109", "the curve is too tight for the tube";
/// The tube runs through itself.
///
/// Two places of the curve come nearer to each other than the tube is thick. Yarn cannot pass through a fabric.
///
/// Wrong: a curve that closes a circle, with ends inside one another
/// Right: a horseshoe with room between its ends.
TubeCrossesItself = "E1110", "the tube runs through itself";
/// A branch does not touch the part that it grows from, or does not come out of it.
///
/// The tube of a branch begins inside of its parent or on its surface, and leaves it on all sides.
///
/// Wrong: on a trunk of radius 2 along z, a branch with `curve = [[3, 0, 5], [6, 0, 5]]`, or one from `[0, 0, 5]` to `[1, 0, 5]`
/// Right: `curve = [[0, 0, 5], [6, 0, 5]]`
BranchApart = "E1114", "a branch does not touch its parent";
/// A branch does not come out of its parent on all sides: it is as wide as the parent, or too far to one side of it, or
/// at an open end.
///
/// The loop in which the two meet must lie on the parent's surface.
///
/// Wrong: a trunk of radius 2 with a branch across it of radius 2.5
/// Right: a branch of radius 1.9 or less
BranchTooWide = "E1115", "a branch does not fit on its parent";
/// Two tubes of a shape run through each other.
///
/// A branch meets its parent once, where it leaves it, and other parts nowhere.
///
/// Wrong: two arms of radius 1 that leave at 0.5 and 0.55 of a trunk of 10 cm on the same side
/// Right: the same arms on opposite sides, or at 0.3 and 0.7
TubesCross = "E1116", "two tubes run through each other";
/// The tube is thinner than four stitches around.
///
/// Fewer than four stitches cannot be worked in the round. Closed ends may shrink to a point, of course.
///
/// Wrong: `circle = 0.2` (cm) with a stitch 0.6 cm wide, 2 stitches around
/// Right: `circle = 0.6`, 6 stitches around, or a finer yarn.
ShapeTooNarrow = "E1111", "the tube is too narrow for the stitch";
/// The shape is shorter than two rows.
///
/// Wrong: a tube of 0.8 cm with stitches 0.55 cm high
/// Right: 1.1 cm and more, or a finer yarn.
ShapeTooShort = "E1112", "the shape is too short for the stitch";
/// The shape takes more stitches than can be handled. Mostly the unit is another one.
///
/// Wrong: `unit = "in"` for a ball of radius 500 with stitches of `width = 0.01`
/// Right: `unit = "mm"` and the gauge in mm.
ShapeTooLarge = "E1113", "the shape is too large for the stitch";
/// The gauge is a guess from yarn and hook.
///
/// Hands differ: sizes may be off by 15 % within the usual hooks of a yarn and 20 % outside of them. Toys are worked
/// with small hooks on purpose, so out of range is normal. A swatch of 10 x 10 stitches replaces the guess.
///
/// Estimated: `yarn = { weight = "worsted", hook = "3.5 mm" }`
/// Measured: `swatch = { width = 4.7, height = 4.1, stitches = 10, rows = 10 }`
GaugeEstimated = "W1201", "the gauge is estimated";
/// The standard counts lace weight in double crochet, so that a single crochet is guessed from another stitch.
///
/// Estimated: `yarn = { weight = 0, hook = "1.5 mm" }`
/// Measured: `swatch = { width = 2.4, height = 2.1, stitches = 10, rows = 10 }`
LaceGauge = "W1202", "the gauge of lace weight is weak";
/// The object is smaller than 8 mm or larger than 3 m. Mostly the unit is another one.
///
/// Wrong: `unit = "in"` for a ball with `circle = 80`, 4 m across
/// Right: `unit = "mm"`
UnlikelySize = "W1203", "an unlikely size";
/// The file names no unit, so its lengths are taken as millimeters.
///
/// Wrong: `circle = 4`, meant as 4 cm, without a unit
/// Right: `unit = "cm"` at the top of the file.
UnitAssumed = "N1204", "the unit is assumed";
/// A file has more findings than are shown. The first ones matter most: later ones often follow from them.
///
/// Shown: the first 64 findings of a file.
/// Hidden: the rest, which a second run shows when the first are mended.
MoreFindings = "N1205", "more findings are not shown";
        }
    };
}
pub(super) use shape;
