//! Diagnostics of machine code and of knitting machines: E20 reading Knitout, E21 running machine code, E22 what a machine cannot make, E23 k-code; W24 and N25 remarks on these.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! machine {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// The first line of a Knitout file is not `;!knitout-2`.
///
/// The magic line names the format and its version. Nothing may stand before it, not even a byte order mark.
///
/// Wrong: `;;Carriers: 1 2 3` as line 1. Right: `;!knitout-2` as line 1, the headers below.
KnitoutMagic = "E2001", "the magic line is missing";
/// An operation that Knitout does not have.
///
/// Opcodes are lower case: in, inhook, releasehook, out, outhook, stitch, rack, knit, tuck, split, drop, amiss, xfer,
/// miss, pause, and extensions that begin with `x-`.
///
/// Wrong: `purl - f10 1`. Right: `knit - b10 1`.
UnknownOperation = "E2002", "no such operation";
/// An operation has too few or too many arguments.
///
/// Wrong: `knit +`. Right: `knit + f10 1`; direction, needle, carriers.
WrongArguments = "E2003", "wrong number of arguments";
/// A needle is not `f`, `b`, `fs` or `bs` with a number.
///
/// Wrong: `drop 10`. Right: `drop f10`, `drop bs-2`.
BadNeedle = "E2004", "not a needle";
/// A direction is neither `+` nor `-`.
///
/// Wrong: `knit f10 1`. Right: `knit + f10 1`.
BadDirection = "E2005", "not a direction";
/// A number is not one, or a rack is no multiple of a quarter needle.
///
/// Wrong: `rack left`, `rack 0.3`. Right: `rack -1`, `rack 0.25`.
BadMachineNumber = "E2006", "not a number";
/// A carrier does not stand in the `Carriers` header.
///
/// Wrong, with `;;Carriers: 1 2 3`: `inhook 11`. Right: `inhook 1`, or add the carrier to the header.
UnknownCarrier = "E2007", "carrier not in the header";
/// A carrier is named twice: in one operation, or in the header.
///
/// Wrong: `in 1 1`. Right: `in 1`.
RepeatedCarrier = "E2008", "carrier named twice";
/// A file of machine code is not UTF-8 text.
///
/// Knitout and k-code are plain text; the label shows the first byte that is not.
MachineCodeNotText = "E2009", "not text";
/// A pattern is wanted and the file is machine code.
///
/// Which crochet stitches a knitting program stands for cannot be told. It can be checked (`picot check in.k`) and
/// converted (`picot build in.k -o out.kc`).
NoPattern = "E2010", "machine code holds no pattern";
/// A carrier is used although it is out.
///
/// Wrong: `knit - f10 1` with no `in 1` or `inhook 1` before it, or after `out 1`.
CarrierOut = "E2101", "carrier used while out";
/// A carrier is brought in although it is in.
///
/// Wrong: `in 1`, `in 1`. Right: `in 1`, knit, `out 1`, `in 1`.
CarrierInTwice = "E2102", "carrier brought in twice";
/// A carrier is taken out although it is not in.
///
/// Wrong: `outhook 2` with no `inhook 2` before it.
CarrierNotIn = "E2103", "carrier taken out while out";
/// A `releasehook` names carriers that the hook does not hold.
///
/// Right: `inhook 1`, the first loops, `releasehook 1`.
HookEmpty = "E2104", "the hook does not hold this yarn";
/// The hook lets go of a yarn that has made no loop.
///
/// Wrong: `inhook 1`, `releasehook 1`, `tuck - f10 1`. Right: the `releasehook` after the first bed of loops.
HookReleasedEarly = "E2105", "the hook is released too early";
/// A yarn comes in with the hook while the hook holds another.
///
/// There is one inserting hook. Right: `inhook 1`, loops, `releasehook 1`, `inhook 2`.
HookOccupied = "E2106", "the hook is occupied";
/// A carrier is taken out while the inserting hook still holds its yarn.
///
/// Right: `releasehook 1` before `outhook 1`.
CarrierInHook = "E2107", "the yarn is still in the hook";
/// A transfer or a split within one bed.
///
/// Wrong: `xfer f10 f11`. Right: `xfer f10 b10`, `rack 1`, `xfer b10 f11`, `rack 0`.
TransferWithinBed = "E2108", "transfer within a bed";
/// A transfer or a split between needles that do not face each other.
///
/// At rack R the back needle B faces the front needle B + R.
///
/// Wrong, at rack 0: `xfer f10 b11`. Right: `rack -1`, `xfer f10 b11`.
TransferUnaligned = "E2109", "the needles do not face each other";
/// A loop is formed on a slider, or the machine has no sliders.
///
/// Sliders hold loops that were transferred to them; they cannot form one.
LoopOnSlider = "E2110", "a loop on a slider";
/// A needle lies beyond the bed (`bed.needles` of the profile).
///
/// Center the program on the bed, or make the object narrower.
NeedleOffBed = "E2111", "needle beyond the bed";
/// A rack is beyond the machine (`rack.max`), or between its steps (`rack.step`).
///
/// Racks of `rack.all_needle` are fine too.
RackBeyond = "E2112", "rack beyond the machine";
/// A hook operation on a machine without inserting hook (`entry.bring_in`).
///
/// Wrong, on a Kniterate: `inhook 1`. Right: `in 1`.
NoHook = "E2113", "the machine has no inserting hook";
/// More carriers than the machine takes: in one operation (`carriers.per_op`), or in all (`carriers.names`).
///
/// Wrong, on a Kniterate: `tuck + f100 1 2`. Right: `tuck + f100 1`, `tuck + f100 2`.
TooManyCarriers = "E2114", "too many carriers";
/// The first pass of a yarn goes the wrong way (`entry.first_direction`).
///
/// The carrier comes from the side where it parks: from the right, its first pass must go left.
FirstDirection = "E2115", "the first pass goes the wrong way";
/// A needle is worked that the parked inserting hook covers (`entry.hook_width`).
///
/// The hook parks just right of the first stitch until `releasehook`.
NeedleUnderHook = "E2116", "needle under the parked hook";
/// An operation that the machine does not perform (`operations`).
///
/// The profile lists what it does.
OperationNotPerformed = "E2117", "operation not performed by the machine";
/// A stitch has no counterpart on a knitting machine.
///
/// Every loop of a tube stays live on its needle until it is worked, so chains inside a round, skipped stitches, rows
/// that turn and parts that begin on loops of another part are not knit. Taller stitches and stitches into one strand
/// can be approximated: `--set approximate=true`.
NotKnittable = "E2201", "no counterpart in knitting";
/// The machine cannot make the object: too wide, too narrow, too many loops on a needle, too long a short row.
///
/// Part, round and stitch say where; the help names the field of the profile and what would fit.
BeyondMachine = "E2202", "the machine cannot make this";
/// A machine program does not make the loops of the pattern.
///
/// The program is executed and its loops are compared with the pattern's: the same stitches, in the same order, each
/// pulled through the same loops. The first difference of a part is shown.
NotTheSame = "E2203", "the program does not make the pattern";
/// A k-code file has no HOME line.
///
/// Right: `HOME` as the first line, after the comments that one dialect begins with.
KcodeHead = "E2301", "no HOME line";
/// The lines of a k-code pass are incomplete, repeated or mixed with others.
///
/// A pass is FRNT, STIF, REAR, STIR and a move, in any order of the first four.
KcodePass = "E2302", "a broken pass";
/// A FRNT or REAR line is not 15 dots, 252 cells, 15 dots, or a STIF or STIR line holds other than 0-9 and A-Z.
///
/// Stop marks (`/`, `\`, digits) stand between the characters of FRNT and REAR and do not count.
KcodeBed = "E2303", "a broken bed line";
/// A move line has a wrong number of fields, or a type that does not fit its direction.
///
/// Wrong: `>> Tr-Rl 0 300 0`. Right: `>> Tr-Rr 0 300 0`, since the last letter follows the direction.
KcodeMove = "E2304", "a broken move";
/// A rack, carrier, speed or roller value is no number or out of range.
///
/// Wrong: `RACK:0.25`, `>> Kn-Kn 7 300 100`. Right: `RACK:0.5`, `>> Kn-Kn 2 300 100`.
KcodeNumber = "E2305", "not a number of k-code";
/// The carriage does not go to and fro: the first pass goes right, then directions alternate.
///
/// Right: a move of the carriage alone between two passes of one direction, `<< Kn-Kn 0 300 0` with nothing marked.
KcodeDirection = "E2306", "passes do not alternate";
/// The stop marks of a pass contradict each other or its move.
///
/// FRNT and REAR have the same marks: one `/`, one `\`, and the number of the carrier that the move names, twice.
KcodeMarks = "E2307", "stop marks disagree";
/// A transfer without its receiving needle, or at a rack at which needles do not face each other.
///
/// At rack R the cell c of REAR faces the cell c + R of FRNT; both are marked `-`.
KcodeTransfer = "E2308", "a broken transfer";
/// A program has something that k-code has no words for.
///
/// A Kniterate has six carriers named 1 to 6, one for each operation, no hook and no sliders, and racks by whole or half
/// needles on a bed of 252.
NotKcode = "E2310", "k-code cannot say this";
/// A stitch without an exact counterpart is knit as a plain loop, as `approximate=true` asks.
Approximated = "W2431", "a stitch is approximated";
/// A tube has fewer loops than the machine is known to hold well (`tube.min_loops`).
NarrowTube = "W2432", "a narrow tube";
/// The number of stitch sizes differs from the number of cells of the bed line.
KcodeSizes = "W2433", "stitch sizes of another length";
/// Crochet cannot be made by a V-bed machine: each stitch is knit as one loop, and nobody has run the file.
///
/// Increases, decreases and short rows stay where they are. The gauge comes from a swatch knit on that machine.
///
/// Example: `picot build ball.toml --machine kniterate -o ball.kc`; the machine reads a file named `command.kc`.
KnitInstead = "N2501", "re-lowered to knitting";
/// A machine profile cannot be read.
///
/// A profile is TOML; `picot list machines` shows every field with its meaning.
BadProfile = "E2190", "the machine profile is broken";
/// A Knitout file has no `Carriers` header.
///
/// Without it, which carriers exist is guessed from their use. Right: `;;Carriers: 1 2 3 4 5 6` below the magic line.
CarriersHeaderMissing = "W2401", "no Carriers header";
/// A header line stands after the comment header, where it is only a comment.
///
/// The comment header ends at the first line that does not begin with `;;`.
LateHeader = "W2402", "header line after the comment header";
/// Lines end in CR LF; the format wants LF.
///
/// Some tools stop at the CR.
CarriageReturns = "W2403", "CR LF line ends";
/// The magic line names a version that is newer than Picot knows.
///
/// The file is read as version 2.
NewerKnitout = "W2404", "newer version of the format";
/// An extension that nobody in sight understands; it is ignored.
///
/// The profile lists the ones of its machine (`extensions`).
UnknownExtension = "W2405", "unknown extension";
/// A header that the format does not have; it is ignored.
///
/// Known are Carriers, Machine, Gauge, Yarn-C, Position and Width; others should begin with `X-`.
UnknownHeader = "W2406", "unknown header";
/// A header stands twice; the last one counts.
DuplicateHeader = "W2407", "header given twice";
/// A line begins with `;;` and is no header, which ends the comment header.
///
/// Wrong: `;;Carriers 1 2 3`. Right: `;;Carriers: 1 2 3`.
MalformedHeader = "W2408", "a `;;` line that is no header";
/// An operation on carriers names none, so it does nothing.
NoCarrier = "W2409", "no carrier named";
/// Loops hang on needles when the program ends.
///
/// Bind off, or drop what is secured; else the piece unravels when it is taken off.
LoopsLeftOnNeedles = "W2411", "loops left on needles";
/// A carrier is in when the program ends.
///
/// The next program meets it in its way. Right: `out` or `outhook` at the end.
CarrierLeftIn = "W2412", "carrier left in";
/// A needle without loops is knit: the loop hangs in nothing, and may not form at all.
///
/// Start a wale with a tuck.
KnitOnEmpty = "W2413", "knit on an empty needle";
/// A drop, transfer or split from a needle that holds no loop.
NeedleEmpty = "W2414", "the needle is empty";
/// Loops are transferred while the yarn is held by the inserting hook, which is in the way.
TransferWithHook = "W2415", "transfer with the yarn in the hook";
/// A needle holds more loops than it can knit (`limits.loops_per_needle`).
StackTooLarge = "W2416", "too many loops on a needle";
/// The yarn floats over more needles than is good (`limits.float`).
LongFloat = "W2417", "long float";
/// Racking or a transfer pulls two neighboring loops too far apart (`limits.link_stretch`).
LinkStretched = "W2418", "stretched link";
/// The bed is racked to where it stands.
RackRedundant = "W2419", "redundant rack";
/// A carrier is brought in and taken out unused.
CarrierUnused = "W2420", "carrier not used";
/// A yarn comes in by the gripper on a machine with a hook: its end is loose.
LooseYarn = "W2421", "loose yarn end";
/// The value of an extension lies outside the range of the profile.
ValueOutOfRange = "W2422", "value out of range";
        }
    };
}
pub(super) use machine;
