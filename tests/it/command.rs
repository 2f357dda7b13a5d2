//! The binary as a test calls it, its streams as text, and folders for its files.

use snapbox::cmd::{Command, OutputAssert};
use std::path::Path;

pub(crate) fn picot(arguments: &[&str]) -> Command {
    Command::new(env!("CARGO_BIN_EXE_picot"))
        .args(arguments)
        .env_remove("NO_COLOR")
        .env_remove("CLICOLOR_FORCE")
        .current_dir(env!("CARGO_MANIFEST_DIR"))
}

pub(crate) fn run(arguments: &[&str]) -> OutputAssert {
    picot(arguments).assert()
}

pub(crate) fn stdout(output: &OutputAssert) -> String {
    String::from_utf8(output.get_output().stdout.clone()).expect("UTF-8")
}

pub(crate) fn stderr(output: &OutputAssert) -> String {
    String::from_utf8(output.get_output().stderr.clone()).expect("UTF-8")
}

/// An empty folder for one test.
pub(crate) struct Folder(tempfile::TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().expect("a temporary folder"))
    }
    pub(crate) fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_str().expect("plain names").to_owned()
    }
    /// Writes a file; its path.
    pub(crate) fn file(&self, name: &str, text: impl AsRef<[u8]>) -> String {
        let path = self.path(name);
        write(&path, text);
        path
    }
    /// The names of all files, sorted.
    pub(crate) fn names(&self) -> Vec<String> {
        let entries = self.0.path().read_dir().expect("readable").flatten();
        let mut names: Vec<String> =
            entries.map(|it| it.file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

#[expect(clippy::disallowed_methods, reason = "tests look at what was written")]
pub(crate) fn read(path: impl AsRef<Path>) -> Vec<u8> {
    std::fs::read(path).expect("written")
}

#[expect(clippy::disallowed_methods, reason = "tests write their cases")]
pub(crate) fn write(path: impl AsRef<Path>, text: impl AsRef<[u8]>) {
    std::fs::write(path, text).expect("writable");
}
