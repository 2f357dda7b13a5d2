//! Diagnostics of previews: W14 and N14 remarks on what is drawn and predicted.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! preview {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// The forces between the stitches did not come to rest, so the shape is a rough one.
///
/// It happens to long thin pieces, and to fabric that ruffles. What is drawn is how far it came; distances to a target
/// are not told.
///
/// Example: a round of 12 in which every stitch is an increase, five times over, ruffles without end.
NotAtRest = "W1401", "the predicted shape is not at rest";
/// A written pattern does not say where its stitches lie. They are predicted: springs of the stitch's width and
/// height, a little stuffing, and no gravity; pieces that are sewn together later lie side by side.
///
/// Example: `picot preview frog.txt -o frog.png`. A shape file in place of the pattern is drawn as designed.
Predicted = "N1402", "the shape is predicted";
/// A pattern without a gauge is drawn with stitches of 5 mm x 4.25 mm. Proportions are right, sizes are not.
///
/// Example: `picot preview frog.txt -o frog.png --gauge 4.5mmx4mm` draws it in your own size.
/// A line `gauge: 4.5 x 4 mm` at the head of the pattern does the same for every target.
GaugeAssumed = "N1403", "the gauge is assumed";
        }
    };
}
pub(super) use preview;
