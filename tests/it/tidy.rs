//! The house rules that a compiler does not hold: who imports whom, what is listed, how files begin and how long they are.

use picot::backends::TARGETS;
use picot::frontend::READERS;
use picot::passes::PASSES;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// Longest file, in lines before its tests.
const LONGEST: usize = 600;
/// Modules that every module may import, and that import nothing.
const OPEN: [&str; 2] = ["math", "settings"];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// All files under a folder of the package with this extension, sorted.
pub(crate) fn files(folder: &str, extension: &str) -> Vec<PathBuf> {
    fn walk(folder: &Path, extension: &str, found: &mut Vec<PathBuf>) {
        for entry in folder.read_dir().into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                walk(&path, extension, found);
            } else if path.extension().is_some_and(|it| it == extension) {
                found.push(path);
            }
        }
    }
    let mut found = Vec::new();
    walk(&root().join(folder), extension, &mut found);
    found.sort();
    found
}

#[expect(clippy::disallowed_methods, reason = "tests look at the files of the package")]
pub(crate) fn text(path: &Path) -> String {
    std::fs::read_to_string(path).expect("readable")
}

fn relative(path: &Path) -> String {
    path.strip_prefix(root()).expect("inside").to_string_lossy().replace('\\', "/")
}

/// The lines before the tests at a file's end.
fn before_tests(text: &str) -> &str {
    text.split("\n#[cfg(test)]\nmod tests").next().unwrap_or(text)
}

/// The import table of ARCHITECTURE.md: lines such as `ir <- diag`.
fn table() -> BTreeMap<String, BTreeSet<String>> {
    let page = text(&root().join("ARCHITECTURE.md"));
    let rows = page.lines().filter_map(|line| line.split_once(" <- "));
    rows.map(|(module, may)| {
        let may = may.split(',').map(str::trim).filter(|name| *name != "nothing");
        (module.trim().to_owned(), may.map(str::to_owned).collect())
    })
    .collect()
}

/// The modules of this crate that a line of code names.
fn imports(line: &str) -> Vec<String> {
    let code = line.split("//").next().unwrap_or_default();
    let mut names = Vec::new();
    for after in code.split("crate::").skip(1) {
        let group = after.strip_prefix('{').and_then(|group| group.split('}').next());
        let parts: Vec<&str> = group.map_or_else(|| vec![after], |group| group.split(',').collect());
        for part in parts {
            let name: String = part.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
            // Macros and items of the crate root begin otherwise.
            if name.chars().next().is_some_and(char::is_lowercase) {
                names.push(name);
            }
        }
    }
    names
}

#[test]
fn modules_import_only_what_the_table_allows() {
    let table = table();
    assert!(table.len() >= 8, "ARCHITECTURE.md has no import table");
    let mut wrong = Vec::new();
    for path in files("src", "rs") {
        let name = relative(&path);
        let module = name.trim_start_matches("src/").split(['/', '.']).next().unwrap_or_default().to_owned();
        if matches!(module.as_str(), "lib" | "main" | "cli") {
            continue;
        }
        let nothing = BTreeSet::new();
        let may = match table.get(&module) {
            Some(may) => may,
            None if OPEN.contains(&module.as_str()) => &nothing,
            None => panic!("{name}: ARCHITECTURE.md does not tell what `{module}` may import"),
        };
        for (number, line) in before_tests(&text(&path)).lines().enumerate() {
            for import in imports(line) {
                if import != module && !may.contains(&import) && !OPEN.contains(&import.as_str()) {
                    wrong.push(format!("{name}:{}: `{module}` may not import `{import}`", number + 1));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn import_scanner_sees_all_forms() {
    assert_eq!(imports("use crate::ir::Gauge;"), ["ir"]);
    assert_eq!(imports("use crate::{diag::Sink, ir};"), ["diag", "ir"]);
    assert_eq!(imports("let x = crate::math::sin(crate::shape::y); // crate::cli"), ["math", "shape"]);
    assert!(imports("use crate::Options;").is_empty());
}

#[test]
fn the_command_line_uses_the_public_library_only() {
    for path in files("src/cli", "rs") {
        let text = text(&path);
        assert!(!text.contains("crate::"), "{} reaches into the crate", relative(&path));
    }
}

#[test]
fn every_file_opens_with_what_lives_there() {
    for folder in ["src", "tests", "benches"] {
        for path in files(folder, "rs") {
            let text = text(&path);
            assert!(text.starts_with("//! "), "{} does not open with `//!`", relative(&path));
        }
    }
}

#[test]
fn files_stay_short() {
    for path in files("src", "rs") {
        let lines = before_tests(&text(&path)).lines().count();
        assert!(lines <= LONGEST, "{} has {lines} lines", relative(&path));
    }
}

/// Modules directly under a folder of `src`.
fn modules(folder: &str) -> BTreeSet<String> {
    let entries = root().join("src").join(folder).read_dir().expect("a folder").flatten();
    let stems = entries.filter_map(|entry| Some(entry.path().file_stem()?.to_str()?.to_owned()));
    stems.filter(|stem| stem != "mod").collect()
}

#[test]
fn every_backend_pass_and_reader_is_listed() {
    let unlisted = |folder: &str, listed: Vec<&str>, helpers: &[&str]| {
        let listed: BTreeSet<String> = listed.into_iter().map(|name| name.replace('-', "_")).collect();
        for module in modules(folder) {
            assert!(
                listed.contains(&module) || helpers.contains(&module.as_str()),
                "src/{folder}/{module} is not listed in src/{folder}/mod.rs"
            );
        }
    };
    unlisted("passes", PASSES.iter().map(|pass| pass.name).collect(), &[]);
    // The writer of knitout takes machine code, not a pattern.
    unlisted("backends", TARGETS.iter().map(|target| target.name).collect(), &["knitout"]);
    // One folder reads all formats of meshes.
    unlisted("frontend", READERS.iter().map(|reader| reader.name).collect(), &["mesh", "unit", "findings"]);
}

#[test]
fn names_and_extensions_are_unique() {
    let unique = |names: Vec<&str>| {
        let set: BTreeSet<&str> = names.iter().copied().collect();
        assert_eq!(set.len(), names.len(), "{names:?}");
    };
    unique(TARGETS.iter().map(|target| target.name).collect());
    unique(TARGETS.iter().map(|target| target.extension).collect());
    unique(READERS.iter().map(|reader| reader.name).collect());
    unique(READERS.iter().flat_map(|reader| reader.extensions).copied().collect());
    unique(PASSES.iter().map(|pass| pass.name).collect());
    unique(picot::diag::Code::ALL.iter().map(|code| code.as_str()).collect());
}

#[test]
fn every_code_has_a_page_and_a_title() {
    for code in picot::diag::Code::ALL {
        let page = code.explanation().trim();
        assert!(!page.is_empty(), "{} has no page", code.as_str());
        let error = code.severity() == picot::diag::Severity::Error;
        assert!(!error || page.contains('\n'), "{} has no page", code.as_str());
        assert!(!code.title().is_empty() && !code.title().ends_with('.'), "{}", code.as_str());
        let form = code.as_str().as_bytes();
        assert!(form.len() == 5 && b"EWN".contains(&form[0]), "{}", code.as_str());
    }
}

#[test]
fn no_snapshot_is_an_orphan() {
    let sources: BTreeMap<String, String> = files("tests/it", "rs")
        .iter()
        .map(|path| (path.file_stem().unwrap_or_default().to_string_lossy().into_owned(), text(path)))
        .collect();
    let shapes: BTreeSet<String> = super::snapshots::shapes().into_iter().map(|(name, _)| name).collect();
    for path in files("tests/it/snapshots", "snap") {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder =
            path.parent().and_then(Path::file_name).unwrap_or_default().to_string_lossy().into_owned();
        let alive = if TARGETS.iter().any(|target| target.name == folder) {
            shapes.contains(&name)
        } else if let Some((module, test)) =
            name.strip_prefix("it__").and_then(|rest| rest.split_once("__")).filter(|_| folder == "snapshots")
        {
            // A case of a test that runs over files has their name behind `@`.
            let test = test.split('@').next().unwrap_or(test);
            sources.get(module).is_some_and(|source| source.contains(test))
        } else {
            sources
                .values()
                .any(|source| source.contains(&format!("\"{folder}\"")) || source.contains(&folder))
        };
        assert!(alive, "{} belongs to no test", relative(&path));
    }
}

#[test]
fn every_shape_has_its_snapshots() {
    for (name, _) in super::snapshots::shapes() {
        for target in TARGETS {
            let path = root().join("tests/it/snapshots").join(target.name).join(format!("{name}.snap"));
            assert!(path.exists(), "{} is missing", relative(&path));
        }
    }
}
