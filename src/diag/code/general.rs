//! Diagnostics of programs of any kind, of files and of usage: E09 the intermediate representation, E90 files.

/// Hands its rows, behind those it is given, to the next table in the list.
macro_rules! general {
    (($next:ident $($later:ident)*) $($rows:tt)*) => {
        $next! { ($($later)*) $($rows)*
/// A structure of the intermediate representation is broken: a defect of the program that made it.
///
/// Graph and pattern must tell the same steps, references must point to what exists. No input can cause it.
///
/// Wrong: a part that picks up loops of a part that does not exist.
/// Right: please report it, with the input that led here.
BrokenProgram = "E0901", "the program is inconsistent";
/// A pattern has more loops, rows or nested repeats than Picot handles.
///
/// The caps keep memory and time in bounds for any input.
///
/// Wrong: `((sc) x 99999) x 99999`
/// Right: at most 100,000 loops in a round and 50 million in all.
TooLarge = "E0902", "too large";
/// A file cannot be read or written.
///
/// The message ends with what the system says: the file does not exist, is a folder, may not be read or written, or is
/// larger than Picot takes. Nothing is written when one of the files of a run fails.
///
/// Wrong: `picot build bal.toml` where the file is `ball.toml`.
/// Right: `picot build shapes/ball.toml`, with the folder that the file lies in.
FileFails = "E9001", "a file cannot be read or written";
/// A file is not UTF-8 text.
///
/// Shape files, patterns and machine code are UTF-8. Old editors may save letters with accents in another coding.
///
/// Wrong: `name = "Bär"` saved as Latin-1, where the ä is the single byte 0xE4
/// Right: the same saved as UTF-8.
NotUtf8 = "E9002", "the file is not UTF-8";
        }
    };
}
pub(super) use general;
