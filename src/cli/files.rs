//! Files in and out: bounded reads, and writes that happen whole or not at all.

use super::Failure;
use picot::diag::{Source, Sources};
use std::fs;
use std::io::{self, IsTerminal, Read, Write};
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// Largest input in bytes.
const MAX_FILE: u64 = 1 << 30;

/// Reads a file, but never more than the cap, whatever its size claims.
#[expect(clippy::disallowed_methods, reason = "the command line is where the bytes come from")]
pub(crate) fn load(name: &str) -> io::Result<Vec<u8>> {
    bounded(fs::File::open(name)?)
}

/// Opens an input; `-` is what came through stdin.
pub(crate) fn open(sources: &mut Sources<'_>, input: &str, stdin: &[u8]) -> Result<Rc<Source>, Failure> {
    let source = if input == "-" { sources.add("<stdin>", stdin.to_vec()) } else { sources.open(input) };
    source.map_err(|error| Failure::file(input, error))
}

/// Reads stdin to its end when one of the inputs is `-`.
pub(crate) fn stdin_if_named<'i>(mut inputs: impl Iterator<Item = &'i String>) -> Result<Vec<u8>, Failure> {
    if !inputs.any(|input| input == "-") {
        return Ok(Vec::new());
    }
    let stdin = io::stdin();
    if stdin.is_terminal() {
        return Err(Failure::usage("input `-` is a terminal").help("pipe a file into it, or name the file"));
    }
    bounded(stdin.lock()).map_err(|error| Failure::file("stdin", error))
}

fn bounded(reader: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    reader.take(MAX_FILE + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MAX_FILE {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, "larger than 1 GiB"));
    }
    Ok(bytes)
}

/// Where an output goes.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Place {
    /// A file.
    File(PathBuf),
    /// Standard output.
    Stdout,
}

/// True when both name the same existing file.
pub(crate) fn same_file(a: &Path, b: &Path) -> bool {
    match (fs::canonicalize(a), fs::canonicalize(b)) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    }
}

/// Writes all outputs. Every file is written beside its place under a temporary name first, and only when all are
/// whole do they take their names, so a full disk or a missing directory leaves no half of anything.
pub(crate) fn write_all(outputs: &[(Place, Vec<u8>)]) -> Result<(), Failure> {
    let mut ready = Vec::new();
    for (place, bytes) in outputs {
        if let Place::File(path) = place {
            let staged =
                stage(path, bytes).map_err(|error| Failure::file(path.display().to_string(), error))?;
            ready.push((path, staged));
        }
    }
    for (path, staged) in ready {
        staged.finish().map_err(|error| Failure::file(path.display().to_string(), error))?;
    }
    for (place, bytes) in outputs {
        if *place == Place::Stdout {
            super::print(bytes)?;
        }
    }
    Ok(())
}

/// An output that is written but has not taken its name.
enum Staged<'b> {
    Temporary(tempfile::NamedTempFile, PathBuf),
    /// A device or a pipe, which no file may replace.
    Direct(PathBuf, &'b [u8]),
}

fn stage<'b>(path: &Path, bytes: &'b [u8]) -> io::Result<Staged<'b>> {
    // A link stays a link: what it points at is replaced.
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    match fs::metadata(&path) {
        Ok(metadata) if metadata.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(metadata) if !metadata.is_file() => return Ok(Staged::Direct(path, bytes)),
        Ok(metadata) if metadata.permissions().readonly() => {
            return Err(io::ErrorKind::PermissionDenied.into());
        }
        Ok(_) | Err(_) => {}
    }
    let parent = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".picot-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(parent)?;
    file.write_all(bytes)?;
    Ok(Staged::Temporary(file, path))
}

impl Staged<'_> {
    fn finish(self) -> io::Result<()> {
        match self {
            Self::Temporary(file, path) => file.persist(path).map(drop).map_err(|error| error.error),
            Self::Direct(path, bytes) => fs::OpenOptions::new().write(true).open(path)?.write_all(bytes),
        }
    }
}
