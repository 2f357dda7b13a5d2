//! Diagnostics of Picot XML: E30 what is refused, W34 remarks.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! xml {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// The file is not well-formed XML.
///
/// Tags must nest and be closed, an attribute stands once and has quotes, there is one root element, and only
/// characters of XML 1.0 occur.
///
/// Wrong: `<round number="1"><work op="sc"></round>`
/// Right: `<round number="1"><work op="sc"/></round>`
XmlSyntax = "E3001", "not well-formed XML";
/// XML allows it, Picot does not: a DOCTYPE, a processing instruction, an entity of one's own.
///
/// They can pull in other files or blow up a small file to a huge one, and say nothing about a pattern.
///
/// Wrong: `<!DOCTYPE program SYSTEM "picot.dtd">`
/// Right: the file begins with `<program xmlns="urn:picot:program:1" ..>`; the schemas are in `grammar/`.
XmlForbidden = "E3002", "a construct that Picot XML does not allow";
/// The file is not UTF-8, or its XML declaration names another encoding.
///
/// Wrong: `<?xml version="1.0" encoding="ISO-8859-1"?>`
/// Right: `<?xml version="1.0" encoding="UTF-8"?>`, saved as UTF-8.
XmlEncoding = "E3003", "the file is not UTF-8";
/// The root element is not `program` in the namespace of Picot.
///
/// Wrong: `<program version="1.0" name="cup" unit="mm">`
/// Right: `<program xmlns="urn:picot:program:1" version="1.0" name="cup" unit="mm">`
XmlNamespace = "E3004", "not a Picot XML file";
/// The major version is not the one that this Picot reads.
///
/// Another major version is another language. A newer minor version is read with a warning.
///
/// Wrong: `version="2.0"`. Right: `version="1.0"`.
XmlVersion = "E3005", "unknown version of Picot XML";
/// An element that does not belong here, or not in this place.
///
/// Wrong: `<round ..><wrok op="sc"/></round>`
/// Right: `<round ..><work op="sc"/></round>`
XmlElement = "E3006", "an unknown or misplaced element";
/// An attribute that the element does not have.
///
/// Wrong: `<work op="sc" time="6"/>`
/// Right: `<work op="sc" times="6"/>`
XmlAttribute = "E3007", "an unknown attribute";
/// An attribute or an element that must be there is not.
///
/// Wrong: `<turn/>`
/// Right: `<turn direction="back"/>`
XmlMissing = "E3008", "a required attribute or element is missing";
/// The value of an attribute is not of its kind: no number, no such word, out of range.
///
/// Wrong: `<work op="sc" times="six"/>`, `<work op="xc"/>`
/// Right: `<work op="sc" times="6"/>`, `<work op="sc"/>`
XmlValue = "E3009", "a bad value";
/// A count, the depth of nesting or the number of attributes passes its cap.
///
/// The caps keep memory and time in bounds for any file: nothing is allocated by a number that a file only claims.
///
/// Wrong: `<repeat times="4000000000">`, or repeats 17 deep.
XmlTooLarge = "E3010", "larger than Picot reads";
/// A reference to a part, a yarn or a node that does not exist.
///
/// Wrong: `<hold loops="6" by="amr"/>` where the part is named `arm`.
/// Right: `<hold loops="6" by="arm"/>`
XmlReference = "E3011", "a reference to what does not exist";
/// A name or an id that must be unique stands twice, or an element that stands once.
///
/// Wrong: two parts with `name="leg"`
/// Right: one part with `copies="2"`, or two names.
XmlDuplicate = "E3012", "given twice";
/// The counts that the file states do not fit its steps.
///
/// Rounds are numbered without gaps, each consumes what the one below produces, and produces what its steps leave.
///
/// Wrong: `<round number="2" consumes="6" produces="12"><work op="inc" times="5"/></round>`
/// Right: `<round number="2" consumes="6" produces="12"><work op="inc" times="6"/></round>`
XmlCounts = "E3013", "the counts do not fit";
/// Text between elements.
///
/// All values stand in attributes; text would be lost, so it is refused. Comments are allowed.
///
/// Wrong: text between two rounds
/// Right: the same as a comment, `<!-- ... -->`
XmlText = "E3014", "text where only elements stand";
/// A newer minor version of Picot XML wrote the file.
///
/// What this version knows is read; every name that it does not know is ignored with a warning of its own.
///
/// Seen: a file of version 1.1 read by a program of version 1.0
/// Better: a newer Picot.
XmlNewer = "W3401", "the file is of a newer minor version";
/// A name that this version does not know, in a file of a newer minor version.
///
/// The rest of the file is read without it. In a file of this version the same name is an error.
///
/// Seen: an attribute such as `mood="calm"` in a file of a newer version
/// Better: a newer Picot.
XmlIgnored = "W3402", "an unknown name is ignored";
/// The first round after a magic ring has the number 1.
///
/// Picot counts the stitches of the ring as round 1, as written patterns do, so the round after it is round 2. The
/// file is read as if its numbers were one higher.
///
/// Read: a ring of 6, then round 1
/// Meant: a ring of 6, then round 2
XmlRingNumber = "W3403", "the rounds do not count the magic ring";
        }
    };
}
pub(super) use xml;
