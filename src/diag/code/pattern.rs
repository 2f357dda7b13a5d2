//! Diagnostics of written patterns: E00 words of a pattern, E01 its loops, E02 its numbering and parts, E03 its short rows; W04 and N05 remarks on it.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! pattern {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// A word or mark of a pattern is not known.
///
/// Nothing that is not understood is skipped or guessed: one unread word can hide a whole increase.
/// Where a known word is one letter away, it is offered.
///
/// Wrong: `Rnd 6: (2 sc, flurb) x 6 (18)`. Right: `Rnd 6: (2 sc, dec) x 6 (18)`, on 24.
/// A stitch of your own is declared: `def flurb = 2 -> 1`.
UnknownTerm = "E0001", "a word that is not known";
/// A bracket or a star has no partner.
///
/// Wrong: `Rnd 5: (3 sc, inc x 4 (20)`. Right: `Rnd 5: (3 sc, inc) x 4 (20)`.
/// Wrong: `3 sc, inc; rep from * 3 more times`. Right: `*3 sc, inc; rep from * 3 more times`.
Unbalanced = "E0002", "a bracket or star without its partner";
/// A multiplier is missing its number, is zero, or stands on both sides.
///
/// Wrong: `(3 sc, inc) x`, `(3 sc, inc) x 0`, `3 x (sc, inc) x 4`. Right: `(3 sc, inc) x 4`.
///
/// A repeat needs one number, before or behind the bracket.
BadMultiplier = "E0003", "a multiplier that says nothing or too much";
/// A number without a stitch, a separator without a clause, or a row without instructions.
///
/// Wrong: `Rnd 4: 3, inc`. Right: `Rnd 4: 3 sc, inc`.
///
/// Every number says how many of what, and every comma stands between two instructions.
MissingOperand = "E0004", "a number or a stitch is missing";
/// The line goes on after all that could be read.
///
/// A labeled line must be read completely.
///
/// Wrong: `Rnd 4: 24 sc (24) (25)`. Right: `Rnd 4: 24 sc (24)`, and remarks behind `//`.
Leftover = "E0005", "something is left over";
/// A number, a line, or the nesting of brackets passes a limit.
///
/// A row may have 100,000 loops, a file 10 million, brackets may nest 16 deep, a line may have one megabyte.
/// The limits keep time and memory in bounds for any text.
///
/// Wrong: `(sc x 999999999) x 999999999`. Right: numbers that can be crocheted.
Limit = "E0006", "too large";
/// The pattern uses `dc`, `tr` or `dtr`, and nothing tells whether they are US or UK terms.
///
/// A US `dc` is three times as high as a UK `dc`. A pattern with only these words needs `terms: us` or `terms: uk`.
/// A pattern with words of both, such as `sc` and `htr`, is refused.
TermsUndecided = "E0007", "US or UK terms";
/// More than one reading fits, and nothing decides.
///
/// Wrong, on 16 loops: `Rnd 6: 3 sc, inc around`; it may mean `(3 sc, inc) around` or `3 sc, then inc to the end`.
/// Right: `Rnd 6: (3 sc, inc) around (20)`, or a stated count that only one reading gives, or a convention in the file.
Ambiguous = "E0008", "more than one reading fits";
/// The text holds bytes or characters that a pattern must not have.
///
/// A pattern is UTF-8 text. Control characters, and marks that change the order in which text is shown, are refused,
/// for what is read must be what is seen.
///
/// Wrong: a file saved as `UTF-16` or `Latin-1`. Right: the same saved as `UTF-8`.
BadText = "E0009", "not readable text";
/// A declaration at the head of the file has a value that means nothing.
///
/// Wrong: `terms: british`. Right: `terms: uk`. Wrong: `convention: star-times=some`. Right: `convention: star-times=more`.
///
/// The declarations are `title`, `terms`, `lang`, `gauge`, `yarn`, `hook`, `color`, `convention` and `def`.
BadHeader = "E0010", "a declaration that means nothing";
/// A row works more loops than the row below left.
///
/// Every stitch is worked into loops of the row below. When those run out, the row cannot be worked.
///
/// Wrong, on 35 loops: `Rnd 8: (4 sc, dec) x 7 (35)` works 42.
/// Right: `Rnd 8: (3 sc, dec) x 7 (28)` works 35.
LoopsExhausted = "E0101", "not enough loops to work into";
/// A round ends although loops of the round below are left.
///
/// Wrong, on 40 loops: `Rnd 9: (6 sc, dec) x 4 (28)` works 32.
/// Right: `Rnd 9: (6 sc, dec) x 5 (35)`.
LoopsLeft = "E0102", "loops of the round below are left unworked";
/// The stated stitch count is not the number of loops that the row makes.
///
/// Wrong, on 21 loops: `Rnd 4: (2 sc, inc) x 7 (27)` makes 28.
/// Right: `Rnd 4: (2 sc, inc) x 7 (28)`.
CountDiffers = "E0103", "the stated count differs from the loops made";
/// A repeat that goes to the end of the row does not come out even.
///
/// Wrong, on 29 loops: `*5 sc, inc; rep from * around`; it fits a multiple of 6 (24 or 30).
/// Right: `*5 sc, inc; rep from * to last 5 sts, 5 sc`.
Indivisible = "E0104", "a repeat that does not fit";
/// A row works loops, but nothing lies below it.
///
/// The first round of a part makes its own loops: a magic ring, a chain, or loops of another part.
///
/// Wrong as a first line: `Rnd 2: [3 sc, inc] around (15)`. Right before it: `Rnd 1: 12 sc in MR (12)`.
NoFoundation = "E0105", "nothing to work into";
/// The foundation chain does not give the stated number of stitches.
///
/// Chains that are skipped at the hook are not worked into.
///
/// Wrong: `Row 1: ch 14, sc in 2nd ch from hook and in each ch across (14)` makes 13.
/// Right: `Row 1: ch 15, sc in 2nd ch from hook and in each ch across (14)`.
ChainLength = "E0106", "the foundation chain has the wrong length";
/// A row has two open-ended repeats, or one inside a counted repeat: no number follows from it.
///
/// Wrong: `sc around, inc around`. Right: `12 sc, inc to end`.
///
/// One open end per row can be worked out from the loops below; the rest of the row needs numbers.
TwoFills = "E0107", "an open-ended repeat that nothing limits";
/// A range of rounds runs backward, overlaps, or does not have as many rounds as it says.
///
/// Wrong: `Rnds 9-7: 24 sc`, `Rnds 7-9 (4 rnds): 24 sc`. Right: `Rnds 7-9 (3 rnds): 24 sc`.
///
/// The rounds of a range follow each other, and the number in brackets is how many they are.
BadRange = "E0201", "a range of rounds that does not add up";
/// A range of rounds changes its count, so one count cannot vouch for all of them.
///
/// Wrong, on 15 loops: `Rnds 4-6: (4 sc, inc) x 3 (18)`. Right: one line a round.
///
/// Right: `Rnd 4: (4 sc, inc) x 3 (18)`, `Rnd 5: (5 sc, inc) x 3 (21)`, `Rnd 6: (6 sc, inc) x 3 (24)`.
RangeChangesCount = "E0202", "a range of rounds that changes its count";
/// A round is missing: the numbers have a gap.
///
/// Rows are numbered without gaps, so that a dropped line shows.
///
/// Wrong: `Rnd 4: ..` and then `Rnd 6: ..`. Right: `Rnd 4: ..`, `Rnd 5: ..`, `Rnd 6: ..`, or `Rnds 4-6: ..`.
RoundMissing = "E0203", "a round is missing";
/// A round number comes twice.
///
/// A line may have been copied twice, or a new part begins that has no name.
///
/// Wrong: two lines `Rnd 5: 24 sc (24)`. Right: `Rnds 5-6: 24 sc (24)`, or `Arm:` on a line before the second `Rnd 1`.
RoundTwice = "E0204", "a round number comes twice";
/// A part or a row that another line names does not exist before it.
///
/// A part starts from parts above it, and a repeat of rows names rows above it.
///
/// Wrong: `Body: join Leg + ch 3 + Leg` without a part `Leg:` before it. Right: `Leg (make 2):` first.
NoSuchPart = "E0205", "no such part or row";
/// A direction mark has no partner: a short row is left open, or closed without having been opened.
///
/// Wrong: `10 sc -> 16 sc`
/// Right: `18 sc <- -8 sc -> 16 sc`
UnbalancedTurn = "E0301", "a turn without its partner";
/// The back pass of a short row is longer than the loops that lie behind the hook.
///
/// A short row works back into loops just made. It never outgrows its round.
///
/// Wrong, on 26 loops: `16 sc, <- 27 sc, -> 27 sc`
/// Right: `16 sc, <- 12 sc, -> 12 sc, 10 sc`
BackPassTooLong = "E0302", "the back pass of a short row is too long";
/// Loops that are held for a part are not picked up by it, or are picked up twice.
///
/// Wrong: `5 sc, hold 8 sts for Arm, 21 sc`, and no part `Arm` that is worked from these loops.
/// Right: the same, and later `Arm: from Body rnd 3 sts 6-13 held`.
HeldLoops = "E0206", "held loops are not used exactly once";
/// A part starts from loops that the part it names does not leave.
///
/// A joined part begins with the open loops of finished parts, each used once, and the chains between them. The numbers
/// of loops must agree: two legs that end on 14 give 28, and 3 chains between and behind them 34.
JoinLoops = "E0207", "joined loops do not add up";
/// A back pass is worked over more than 0.6 of its round.
///
/// It can be worked, but a short row that long is hard to count and rarely lies flat.
///
/// Long, on 26 loops: `22 sc, <- 20 sc, -> 20 sc, 4 sc`
/// Better: `18 sc, <- 12 sc, -> 12 sc, 8 sc`
BackPassLong = "W0408", "the back pass of a short row is long";
/// A decrease takes one loop from either side of a turn.
///
/// At the turn of a short row neighboring loops stand one row apart; working them together pulls the fabric.
/// Wrong, on 20: `12 sc <- -4 sc -> 3 sc, dec, 7 sc`. Right: `12 sc <- -4 sc -> 2 sc, dec, 8 sc`.
SpansTurn = "W0409", "a stitch spans a turn";
/// The sign of a back pass stands at a stitch that is worked forward.
///
/// Wrong: `10 sc, -6 sc`. Right: `10 sc <- -6 sc -> 16 sc`.
///
/// The sign repeats what the mark `<-` says, so it is right only between `<-` and `->`.
StrayBackSign = "E0303", "the sign of a back pass outside of one";
/// The count of loops shows that a phrase has another meaning here than its usual one.
///
/// The reading that fits both the loops below and the stated count was taken. Declare it, and the warning goes away.
///
/// Example: `*7 sc, sc2tog; rep from * 3 times (32)` on 36 means 4 passes; `convention: star-times=more` says so.
ReadingOverruled = "W0401", "read otherwise than by convention, because the loops say so";
/// Two rows of one file need different readings of the same phrase.
///
/// A maker means the same phrase the same way throughout, so one of the two rows is probably wrong.
///
/// Declare what is meant, for example `convention: star-times=total`, and the other row is reported.
ReadingsMixed = "W0402", "two readings of one phrase in one file";
/// A turning chain of three or more may or may not count as a stitch, and nothing says it.
///
/// Write `ch 3 (counts as dc)` or `ch 3 (does not count)`.
///
/// Chains of one or two are taken for mere height; a chain of three is as high as a US `dc` and often stands for one.
TurningChainUnsaid = "W0403", "a turning chain that may count";
/// Round numbers begin anew, so a new part without a name begins.
///
/// Wrong: a second `Rnd 1: 6 sc in MR` in the middle of a file.
/// Right: `Arm:` on a line of its own before it.
PartUnnamed = "W0404", "a new part without a name";
/// A row ends with a turn before all loops are worked.
///
/// This is read only with `convention: unworked=turn`.
/// Right: `sc in next 13 sts, leave last 7 sts unworked`.
LoopsRemain = "W0405", "loops remain beyond a turn";
/// The marks of a short row leave no loop for the turn itself, as the paper's tiles need one.
///
/// The row can be worked. Example on 24: `6 sc <- -6 sc -> 24 sc` goes back over all stitches made so far.
/// With `convention: turn-mark=bare` nothing is said about it.
TurnTight = "W0406", "no loop left for the turn";
/// Loops are held for a part that the file does not hold.
///
/// The pattern is read as far as it goes; the loops wait on a piece of yarn.
/// Right: a part such as `Arm: from Body rnd 2 sts 6-13 held`.
HeldForNobody = "W0410", "loops held for a part that is not in the file";
/// `evenly spaced` leaves the places open; they were spread by equal gaps.
///
/// Example: `20 sc, 4 dec evenly spaced` becomes `2 sc, dec, 5 sc, dec, 5 sc, dec, 5 sc, dec, 3 sc`, half a gap at the start.
/// Write the repeat out where the places matter, or declare `convention: evenly=refuse`.
SpreadEvenly = "N0501", "places chosen";
/// A row goes into chain spaces. It was checked for running past the end, but not loop by loop.
///
/// Example: `(2 dc, ch 1, 2 dc) in next ch-1 sp`: a space is a place, not a loop.
/// The stated count is still held against the stitches made.
NotChecked = "N0502", "not checked loop by loop";
/// A line without instructions was kept as a note.
///
/// Example: `Attach the eyes between rounds 7 and 8.`
/// A remark that begins with `//` or `note:` is kept without a word.
LineKept = "N0503", "a line kept as a note";
/// More than one reading was possible; the loops below and the stated count decided.
///
/// Example on 32: `6 sc, dec around (28)` can only mean that the whole list is repeated.
/// Declare the convention, here `trailing-around=list`, and nothing is left open.
ReadingByCount = "N0504", "a reading decided by the count";
/// A row could not be read, so the next one starts from its stated count.
///
/// Nothing is filled in for a line that cannot be read. Example: after `Rnd 6: (2 sc, flurb) x 6 (18)` the next round
/// is checked on 18 loops.
FromStated = "N0505", "goes on from a stated count";
        }
    };
}
pub(super) use pattern;
