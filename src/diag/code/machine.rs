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
/// Wrong: `knit +`.
/// Right: `knit + f10 1`; direction, needle, carriers.
WrongArguments = "E2003", "wrong number of arguments";
/// A needle is not `f`, `b`, `fs` or `bs` with a number.
///
/// Wrong: `drop 10`.
/// Right: `drop f10`, `drop bs-2`.
BadNeedle = "E2004", "not a needle";
/// A direction is neither `+` nor `-`.
///
/// Wrong: `knit f10 1`.
/// Right: `knit + f10 1`.
BadDirection = "E2005", "not a direction";
/// A number is not one, or a rack is no multiple of a quarter needle.
///
/// Wrong: `rack left`, `rack 0.3`.
/// Right: `rack -1`, `rack 0.25`.
BadMachineNumber = "E2006", "not a number";
/// A carrier does not stand in the `Carriers` header.
///
/// Wrong, with `;;Carriers: 1 2 3`: `inhook 11`.
/// Right: `inhook 1`, or add the carrier to the header.
UnknownCarrier = "E2007", "carrier not in the header";
/// A carrier is named twice: in one operation, or in the header.
///
/// Wrong: `in 1 1`.
/// Right: `in 1`.
RepeatedCarrier = "E2008", "carrier named twice";
/// A file of machine code is not UTF-8 text.
///
/// Knitout and k-code are plain text; the label shows the first byte that is not.
///
/// Wrong: a file saved as UTF-16, or `;;Yarn-1: cône` saved as Latin-1. Right: the same saved as UTF-8.
MachineCodeNotText = "E2009", "not text";
/// A pattern is wanted and the file is machine code.
///
/// Which crochet stitches a knitting program stands for cannot be told. It can be checked (`picot check in.k`) and
/// converted (`picot build in.k -o out.kc`).
///
/// Wrong: `picot build sleeve.k --to crochet`. Right: `picot build sleeve.toml --to crochet`, the shape or pattern it was made from.
NoPattern = "E2010", "machine code holds no pattern";
/// A carrier is used although it is out.
///
/// A yarn has to come in before it can make a loop, and cannot make one after it went out.
///
/// Wrong: `knit - f10 1` with no `in 1` or `inhook 1` before it, or after `out 1`.
/// Right: `inhook 1`, `knit - f10 1`, and `outhook 1` only after its last loop.
CarrierOut = "E2101", "carrier used while out";
/// A carrier is brought in although it is in.
///
/// Wrong: `in 1`, `in 1`.
/// Right: `in 1`, knit, `out 1`, `in 1`.
CarrierInTwice = "E2102", "carrier brought in twice";
/// A carrier is taken out although it is not in.
///
/// Mostly another carrier is meant, or the yarn went out already.
///
/// Wrong: `inhook 1`, knit, `outhook 2`. Right: `inhook 1`, knit, `outhook 1`.
CarrierNotIn = "E2103", "carrier taken out while out";
/// A `releasehook` names carriers that the hook does not hold.
///
/// The carriers are those of the `inhook` before it, in any order.
///
/// Wrong: `inhook 1`, the first loops, `releasehook 2`. Right: `inhook 1`, the first loops, `releasehook 1`.
HookEmpty = "E2104", "the hook does not hold this yarn";
/// The hook lets go of a yarn that has made no loop.
///
/// Wrong: `inhook 1`, `releasehook 1`, `tuck - f10 1`.
/// Right: the `releasehook` after the first bed of loops.
HookReleasedEarly = "E2105", "the hook is released too early";
/// A yarn comes in with the hook while the hook holds another.
///
/// There is one inserting hook.
///
/// Wrong: `inhook 1`, loops, `inhook 2`. Right: `inhook 1`, loops, `releasehook 1`, `inhook 2`.
HookOccupied = "E2106", "the hook is occupied";
/// A carrier is taken out while the inserting hook still holds its yarn.
///
/// The hook holds the yarn's beginning, and taking the carrier out needs the hook too.
///
/// Wrong: `inhook 1`, loops, `outhook 1`. Right: `inhook 1`, loops, `releasehook 1`, `outhook 1`.
CarrierInHook = "E2107", "the yarn is still in the hook";
/// A transfer or a split within one bed.
///
/// Wrong: `xfer f10 f11`.
/// Right: `xfer f10 b10`, `rack 1`, `xfer b10 f11`, `rack 0`.
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
///
/// Wrong: `knit - fs10 1`. Right: `knit - f10 1`; and on a machine without sliders (`bed.sliders`), `xfer f10 b10` instead of
/// `xfer f10 bs10`.
LoopOnSlider = "E2110", "a loop on a slider";
/// A needle lies beyond the bed (`bed.needles` of the profile).
///
/// Needle numbers may be negative in Knitout, but each machine has a first and a last needle.
///
/// Wrong, on a bed of 1 to 252: `knit + f0 2`, `knit + f253 2`. Right: needles 1 to 252; center the program on the bed, or
/// make the object narrower.
NeedleOffBed = "E2111", "needle beyond the bed";
/// A rack is beyond the machine (`rack.max`), or between its steps (`rack.step`).
///
/// Racks of `rack.all_needle`, at which both beds knit in one pass, are fine too.
///
/// Wrong, with `rack.max` 4 and `rack.step` 1: `rack 6`, `rack 0.25`. Right: `rack 4`, `rack -2`; farther moves go in two steps.
RackBeyond = "E2112", "rack beyond the machine";
/// A hook operation on a machine without inserting hook (`entry.bring_in`).
///
/// Wrong, on a Kniterate: `inhook 1`.
/// Right: `in 1`.
NoHook = "E2113", "the machine has no inserting hook";
/// More carriers than the machine takes: in one operation (`carriers.per_op`), or in all (`carriers.names`).
///
/// Wrong, on a Kniterate: `tuck + f100 1 2`.
/// Right: `tuck + f100 1`, `tuck + f100 2`.
TooManyCarriers = "E2114", "too many carriers";
/// The first pass of a yarn goes the wrong way (`entry.first_direction`).
///
/// The carrier comes from the side where it parks: from the right, its first pass must go left.
///
/// Wrong, on a machine with hook: `inhook 1`, `tuck + f10 1`. Right: `inhook 1`, `tuck - f10 1`.
FirstDirection = "E2115", "the first pass goes the wrong way";
/// A needle is worked that the parked inserting hook covers (`entry.hook_width`).
///
/// The hook parks just right of the first stitch until `releasehook`.
///
/// Wrong: `inhook 1`, `tuck - f38 1`, `tuck + b39 1`. Right: `inhook 1`, `tuck - f38 1`, more loops to the left,
/// `releasehook 1`, `tuck + b39 1`.
NeedleUnderHook = "E2116", "needle under the parked hook";
/// An operation that the machine does not perform (`operations`).
///
/// The profile lists what it does, under the names of Knitout.
///
/// Wrong, with `operations = ["knit", "tuck", "xfer"]`: `split - f10 b10 1`. Right: `knit` and `xfer` in its place, or
/// `split` added to the list of a machine that can do it.
OperationNotPerformed = "E2117", "operation not performed by the machine";
/// A stitch has no counterpart on a knitting machine.
///
/// Every loop of a piece stays on its needle until it is worked, so skipped stitches and groups of more than three stitches
/// in one place are not knit. Taller stitches and stitches into one strand can be approximated, each with a warning.
///
/// Wrong: `Rnd 3: 12 dc (12)`, knit by machine. Right: `Rnd 3: 12 sc (12)`, or the same with `--set approximate=true`.
NotKnittable = "E2201", "no counterpart in knitting";
/// The machine cannot make the object: too wide, too narrow, too many loops on a needle, too long a short row.
///
/// Part, round and stitch say where; the help names the field of the profile and what would fit.
///
/// Wrong, on a Kniterate with 252 needles: a round of 300 stitches. Right: at most 252, with coarser stitches or in two
/// tubes; or a wider machine, `--machine swg091n2`.
BeyondMachine = "E2202", "the machine cannot make this";
/// A machine program does not make the loops of the pattern.
///
/// The program is executed and its loops are compared with the pattern's: the same stitches, in the same order, each
/// pulled through the same loops. The first difference is shown.
///
/// Wrong: `picot check ball.k --against egg.toml`, or a file from which a line was lost.
/// Right: `picot check ball.k --against ball.toml`, on the file as `picot build` wrote it.
NotTheSame = "E2203", "the program does not make the pattern";
/// A part begins on stitches of finished fabric.
///
/// A needle works loops that hang on needles. Loops in finished fabric have left them, and no machine picks them up again.
///
/// Wrong: `Arm: from Body rnd 4 sts 3-8 surface`, knit by machine.
/// Right: a round of the body that sets the loops aside, `5 sc, hold 6 sts for Arm, 20 sc`, and `Arm: from Body rnd 4 sts 6-11
/// held`; or `--set approximate=true`, which knits the arm from a cast-on of its own, to be sewn on.
LoopsFinished = "E2204", "finished loops cannot be picked up";
/// The pattern has more colors than the machine has carriers for pieces.
///
/// Each color needs a carrier of its own. Those of waste yarn and draw thread cannot be used for pieces.
///
/// Wrong: five colors on a machine with six carriers of which two hold waste yarn and draw thread.
/// Right: four colors, or another machine.
TooFewCarriers = "E2205", "too few carriers for the colors";
/// Limbs of one object hang on the beds together, and one is in another's way.
///
/// On two beds two tubes can be joined to one when they lie side by side. Loops that wait between them, a third tube, or
/// a yarn that would have to pass waiting loops cannot be had.
///
/// Wrong: a body that joins three legs.
/// Right: two legs are joined first, and the third leg to what they became.
LimbsInTheWay = "E2206", "limbs in each other's way";
/// The pattern is made for the habits of a maker's hand, which a machine has not.
///
/// A pattern for left-handed work is that of the mirror image: a left hand mirrors it back, a machine does not. A
/// pattern for stitches that lean is twisted, and knit loops do not twist it back.
///
/// Wrong: `picot build sleeve.toml --set hand=left --machine kniterate -o sleeve.k`
/// Right: the same without `--set hand=left`, and without `hand` and `lean` in the table `[maker]` of the file
ForHands = "E2207", "made for a hand, not for a machine";
/// A k-code file has no HOME line.
///
/// The carriage finds its zero first. One dialect has three comment lines before it.
///
/// Wrong: a file that begins with `FRNT:..`. Right: `HOME` as the first line, `RACK:0` as the second.
KcodeHead = "E2301", "no HOME line";
/// The lines of a k-code pass are incomplete, repeated or mixed with others.
///
/// A pass is FRNT, STIF, REAR, STIR and a move, in any order of the first four.
///
/// Wrong: `FRNT:..`, `STIF:..`, `>> Kn-Kn 2 300 100`. Right: `FRNT:..`, `STIF:..`, `REAR:..`, `STIR:..`, `>> Kn-Kn 2 300 100`.
KcodePass = "E2302", "a broken pass";
/// A FRNT or REAR line is not 15 dots, 252 cells, 15 dots, or a STIF or STIR line holds other than 0-9 and A-Z.
///
/// Stop marks (`/`, `\`, digits) stand between the characters of FRNT and REAR and do not count.
///
/// Wrong: `FRNT:` with 14 dots before the cells, or `x` for a needle. Right: 15 dots, `_` for a needle at rest, `-` for one
/// that works, 15 dots.
KcodeBed = "E2303", "a broken bed line";
/// A move line has a wrong number of fields, or a type that does not fit its direction.
///
/// Wrong: `>> Tr-Rl 0 300 0`.
/// Right: `>> Tr-Rr 0 300 0`, since the last letter follows the direction.
KcodeMove = "E2304", "a broken move";
/// A rack, carrier, speed or roller value is no number or out of range.
///
/// Wrong: `RACK:0.25`, `>> Kn-Kn 7 300 100`.
/// Right: `RACK:0.5`, `>> Kn-Kn 2 300 100`.
KcodeNumber = "E2305", "not a number of k-code";
/// The carriage does not go to and fro: the first pass goes right, then directions alternate.
///
/// A carriage that is at the right end can only go left.
///
/// Wrong: `>> Kn-Kn 2 300 100`, `>> Kn-Kn 2 300 100`.
/// Right: a move of the carriage alone between them, `<< Kn-Kn 0 300 0` with nothing marked.
KcodeDirection = "E2306", "passes do not alternate";
/// The stop marks of a pass contradict each other or its move.
///
/// FRNT and REAR have the same marks: one `/`, one `\`, and the number of the carrier that the move names, twice.
///
/// Wrong: marks `/3 3\` in a pass `>> Kn-Kn 2 300 100`. Right: `/2 2\` there.
KcodeMarks = "E2307", "stop marks disagree";
/// A transfer without its receiving needle, or at a rack at which needles do not face each other.
///
/// At rack R the cell c of REAR faces the cell c + R of FRNT; both are marked `-`.
///
/// Wrong: `RACK:1`, cell 10 marked in both beds, `>> Tr-Rr 0 300 0`. Right: cell 11 of FRNT and cell 10 of REAR.
KcodeTransfer = "E2308", "a broken transfer";
/// A program has something that k-code has no words for.
///
/// A Kniterate has six carriers named 1 to 6, one for each operation, no hook and no sliders, and racks by whole or half
/// needles on a bed of 252.
///
/// Wrong: `inhook 1`, `rack 0.25`, `knit + f1 1 2`. Right: `in 1`, `rack 0.5`, one carrier in each operation.
NotKcode = "E2310", "k-code cannot say this";
/// A stitch without an exact counterpart is knit as a plain loop, as `approximate=true` asks.
///
/// A whole round of tall stitches becomes as many courses as it is high; among others a tall stitch is one loop.
///
/// Wrong, if it must look the same: `Rnd 3: (2 sc, dc) x 6 (18)`. Right: `Rnd 3: 18 sc (18)`, which is knit as it stands.
Approximated = "W2431", "a stitch is approximated";
/// A tube has fewer loops than the machine is known to hold well (`tube.min_loops`).
///
/// The take-down pulls on few loops then, and they may jump off.
///
/// Wrong: a cord of 4 loops without watching the take-down. Right: 8 loops and more, or a weight hung on by hand.
NarrowTube = "W2432", "a narrow tube";
/// A part begins on finished stitches, and is cast on by itself, as `approximate=true` asks.
///
/// Sew it on by hand, loop to loop.
///
/// Sewn: `Arm: from Body rnd 4 sts 3-8 surface`. Without a seam: a part that begins on loops set aside with `hold`.
SewOn = "W2434", "to be sewn on by hand";
/// The number of stitch sizes differs from the number of cells of the bed line.
///
/// The sizes are taken from the cells that there are.
///
/// Wrong: `STIF:555` below a bed line of 282 characters. Right: 282 sizes, `0` for a bed at rest.
KcodeSizes = "W2433", "stitch sizes of another length";
/// Crochet cannot be made by a V-bed machine: each stitch is knit as one loop, and nobody has run the file.
///
/// Increases, decreases and short rows stay where they are. The gauge comes from a swatch knit on that machine.
///
/// Example: `picot build ball.toml --machine kniterate -o ball.kc`; the machine reads a file named `command.kc`.
KnitInstead = "N2501", "re-lowered to knitting";
/// A machine profile cannot be read.
///
/// A profile is TOML; `picot list machines` shows every field with its meaning, and unknown ones are refused.
///
/// Wrong: `[bed]` with `needles = 252`. Right: `needles = [1, 252]`.
BadProfile = "E2190", "the machine profile is broken";
/// A Knitout file has no `Carriers` header.
///
/// Without it, which carriers exist is guessed from their use, and their places are not known.
///
/// Wrong: `;!knitout-2`, then `inhook 1`. Right: `;;Carriers: 1 2 3 4 5 6` below the magic line.
CarriersHeaderMissing = "W2401", "no Carriers header";
/// A header line stands after the comment header, where it is only a comment.
///
/// The comment header ends at the first line that does not begin with `;;`.
///
/// Wrong: `rack 0`, then `;;Gauge: 7`. Right: `;;Gauge: 7` right below the magic line.
LateHeader = "W2402", "header line after the comment header";
/// Lines end in CR LF; the format wants LF.
///
/// Some tools stop at the CR, or take it for a part of a carrier's name.
///
/// Wrong: a file saved with the line ends of Windows. Right: the same saved with LF.
CarriageReturns = "W2403", "CR LF line ends";
/// The magic line names a version that is newer than Picot knows.
///
/// The file is read as version 2; what is new in it may be missed.
///
/// Wrong: `;!knitout-9`, unless such a version exists. Right: `;!knitout-2`.
NewerKnitout = "W2404", "newer version of the format";
/// An extension that nobody in sight understands; it is ignored.
///
/// The profile lists the ones of its machine (`extensions`).
///
/// Wrong: `x-stich-number 5`. Right: `x-stitch-number 5`.
UnknownExtension = "W2405", "unknown extension";
/// A header that the format does not have; it is ignored.
///
/// Known are Carriers, Machine, Gauge, Yarn-C, Position and Width; others should begin with `X-`.
///
/// Wrong: `;;Author: Ada`. Right: `;;X-Author: Ada`, or a comment with one `;`.
UnknownHeader = "W2406", "unknown header";
/// A header stands twice; the last one counts.
///
/// Tools differ in which one they take, so only one should stand there.
///
/// Wrong: `;;Gauge: 7`, `;;Gauge: 15`. Right: `;;Gauge: 15`.
DuplicateHeader = "W2407", "header given twice";
/// A line begins with `;;` and is no header, which ends the comment header.
///
/// Wrong: `;;Carriers 1 2 3`.
/// Right: `;;Carriers: 1 2 3`.
MalformedHeader = "W2408", "a `;;` line that is no header";
/// An operation on carriers names none, so it does nothing.
///
/// Nothing comes in, goes out or is let go.
///
/// Wrong: `in`, `inhook`, `outhook`. Right: `inhook 1`.
NoCarrier = "W2409", "no carrier named";
/// Loops hang on needles when the program ends.
///
/// Bind off, or drop what is secured; else the piece unravels when it is taken off.
///
/// Wrong: a program that ends after its last course. Right: a chain over the last loops, and a `drop` of its tail.
LoopsLeftOnNeedles = "W2411", "loops left on needles";
/// A carrier is in when the program ends.
///
/// The next program meets it in its way.
///
/// Wrong: `inhook 1`, knit, and the end of the file. Right: `inhook 1`, knit, `outhook 1`.
CarrierLeftIn = "W2412", "carrier left in";
/// A needle without loops is knit: the loop hangs in nothing, and may not form at all.
///
/// Start a wale with a tuck, or give the needle a loop by a transfer.
///
/// Wrong: `knit - f20 1` where f20 is empty. Right: `tuck - f20 1`, and `knit` in the next course.
KnitOnEmpty = "W2413", "knit on an empty needle";
/// A drop, transfer or split from a needle that holds no loop.
///
/// Mostly an earlier transfer moved the loop, or the needle is misspelled.
///
/// Wrong: `drop f10`, `drop f10`. Right: `drop f10` once, while it holds a loop.
NeedleEmpty = "W2414", "the needle is empty";
/// Loops are transferred while the yarn is held by the inserting hook, which is in the way.
///
/// The hook holds the beginning of the yarn beside the first stitch.
///
/// Wrong: `inhook 1`, loops, `xfer f10 b10`. Right: `inhook 1`, loops, `releasehook 1`, `xfer f10 b10`.
TransferWithHook = "W2415", "transfer with the yarn in the hook";
/// A needle holds more loops than it can knit (`limits.loops_per_needle`).
///
/// The loops may not all pass the hook of the needle, and some stay behind.
///
/// Wrong, with a limit of 4: five transfers to f10. Right: `knit` at f10 before it takes more.
StackTooLarge = "W2416", "too many loops on a needle";
/// The yarn floats over more needles than is good (`limits.float`).
///
/// A long float hangs loose inside the piece and catches on needles.
///
/// Wrong, with a limit of 20: `knit + f10 1`, then `knit + f40 1`. Right: `tuck + f25 1` on the way, or the yarn taken out and
/// brought in anew.
LongFloat = "W2417", "long float";
/// Racking or a transfer pulls two neighboring loops too far apart (`limits.link_stretch`).
///
/// The yarn between them may break, or pull a loop off.
///
/// Wrong, with a limit of 6: two loops side by side, one of them moved 8 needles away. Right: the neighbors moved along, in
/// steps of 2.
LinkStretched = "W2418", "stretched link";
/// The bed is racked to where it stands.
///
/// It costs time and does nothing.
///
/// Wrong: `rack 1`, `rack 1`. Right: `rack 1` once.
RackRedundant = "W2419", "redundant rack";
/// A carrier is brought in and taken out unused.
///
/// It costs a pass each way.
///
/// Wrong: `inhook 2`, `outhook 2`. Right: neither, or loops between them.
CarrierUnused = "W2420", "carrier not used";
/// A yarn comes in by the gripper on a machine with a hook: its end is loose.
///
/// The end can slip out of the first loops.
///
/// Wrong, on a machine with hook: `in 1`. Right: `inhook 1`, the first loops, `releasehook 1`.
LooseYarn = "W2421", "loose yarn end";
/// The value of an extension lies outside the range of the profile.
///
/// The machine takes the nearest value, or stops.
///
/// Wrong, with speeds from 0 to 15: `x-speed-number 300`. Right: `x-speed-number 10`.
ValueOutOfRange = "W2422", "value out of range";
        }
    };
}
pub(super) use machine;
