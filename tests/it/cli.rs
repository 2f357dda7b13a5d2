//! The command line from the outside: exit status, streams, and files that are written whole or not at all.

use crate::command::{Folder, picot, read, run, stderr, stdout, write};
use snapbox::str;
use std::path::{Path, PathBuf};
use std::process::Stdio;

const BALL: &str = "shapes/paper/c.toml";

#[test]
fn no_arguments_print_short_help_with_examples() {
    let output = run(&[]).code(2).stdout_eq("");
    let help = stderr(&output);
    assert!(help.contains("Usage: picot") && help.contains("Examples:"), "{help}");
    assert_eq!(help.matches("  picot build").count(), 2, "{help}");
}

#[test]
fn help_of_build() {
    run(&["build", "-h"]).code(0).stderr_eq("").stdout_eq(str![[r"
Compile a shape to a pattern and other outputs

Usage: picot build [OPTIONS] <INPUT>...
...
      --set <KEY=VALUE>  Set an option of the generator or of a target (`picot list targets` shows
                         the keys)
...
Examples:
  picot build shapes/ball.toml                    print the pattern
  picot build a.toml b.toml --to json -o out/     one file for each input
  cat ball.toml | picot build - --from shape -o ball.txt

"]]);
}

#[test]
fn wrong_usage_is_status_2_with_a_way_out() {
    let cases: [(&[&str], &str); 14] = [
        (&["biuld"], "build"),
        (&["build"], "<INPUT>"),
        (&["build", BALL, "--to", "crochte"], "crochet"),
        (&["build", BALL, "-o", "x.tx"], "did you mean `.txt`?"),
        (&["build", BALL, "-o", "x"], "--to"),
        (&["build", "x.tmol"], "did you mean `.toml`?"),
        (&["build", "-"], "--from"),
        (&["build", BALL, "--set", "short-row=false"], "did you mean `short-rows`?"),
        (&["build", BALL, "--set", "sweeps=many"], "expected a whole number"),
        (&["build", BALL, "--set", "squareness=much"], "expected a number, as 0.5"),
        (&["build", BALL, "--set", "sweeps"], "KEY=VALUE"),
        (&["build", BALL, "--gauge", "2.5"], "2.5mmx2.5mm"),
        (&["build", BALL, "--to", "crochet", "--to", "json"], "-o FILE"),
        (&["explain", "E0109"], "did you mean"),
    ];
    for (arguments, way_out) in cases {
        let output = run(arguments).code(2).stdout_eq("");
        assert!(stderr(&output).contains(way_out), "{arguments:?}: {}", stderr(&output));
    }
}

#[test]
fn one_text_target_goes_to_stdout() {
    let output = run(&["build", BALL]).code(0);
    assert!(stdout(&output).contains("Rnd"), "{}", stdout(&output));
    assert!(stderr(&output).contains("rounds") && stderr(&output).contains("Next: "), "{}", stderr(&output));
    let quiet = run(&["build", BALL, "-q"]).code(0).stderr_eq("");
    assert_eq!(stdout(&output), stdout(&quiet));
}

#[test]
fn stdin_and_stdout_give_the_same_bytes_as_files() {
    let folder = Folder::new();
    let file = folder.path("c.json");
    run(&["build", BALL, "-o", &file]).code(0).stdout_eq("");
    let piped = picot(&["build", "-", "--from", "shape", "--to", "json", "-o", "-"])
        .stdin(String::from_utf8(read(Path::new(env!("CARGO_MANIFEST_DIR")).join(BALL))).expect("UTF-8"))
        .assert()
        .code(0);
    assert_eq!(piped.get_output().stdout, read(&file));
}

#[test]
fn a_target_follows_from_the_extension_unless_it_is_named() {
    let folder = Folder::new();
    let (text, json, odd) = (folder.path("c.txt"), folder.path("c.json"), folder.path("c.odd"));
    run(&["build", BALL, "-o", &text, "-o", &json]).code(0);
    run(&["build", BALL, "--to", "json", "-o", &odd]).code(0);
    assert_eq!(read(&odd), read(&json));
    assert_ne!(read(&text), read(&json));
    run(&["build", BALL, "--to", "json", "-o", &text]).code(0);
    assert_eq!(read(&text), read(&json));
    assert_eq!(folder.names(), ["c.json", "c.odd", "c.txt"]);
}

#[test]
fn many_inputs_go_into_a_directory() {
    let folder = Folder::new();
    let out = folder.path("");
    run(&["build", BALL, "shapes/paper/d.toml", "--to", "crochet", "--to", "json", "-o", &out]).code(0);
    assert_eq!(folder.names(), ["c.json", "c.txt", "d.json", "d.txt"]);
    let output = run(&["build", BALL, "shapes/paper/d.toml"]).code(2).stdout_eq("");
    assert!(stderr(&output).contains("DIRECTORY/"), "{}", stderr(&output));
}

#[test]
fn nothing_is_written_when_one_output_cannot_be() {
    let folder = Folder::new();
    let good = folder.path("c.txt");
    write(&good, "before");
    run(&["build", BALL, "-o", &good, "-o", &folder.path("missing/c.json")]).code(3).stdout_eq("");
    assert_eq!(read(&good), b"before");
    assert_eq!(folder.names(), ["c.txt"]);
}

#[test]
fn nothing_is_written_when_one_input_is_bad() {
    let folder = Folder::new();
    let bad = folder.path("bad.toml");
    write(&bad, "name = 'bad'\nunit = 'furlong'\n");
    let out = folder.path("out");
    std::fs::create_dir(&out).expect("writable");
    let output = run(&["build", BALL, &bad, "--to", "json", "-o", &out]).code(1).stdout_eq("");
    assert!(stderr(&output).contains("error[E"), "{}", stderr(&output));
    assert_eq!(PathBuf::from(&out).read_dir().expect("readable").count(), 0);
}

#[test]
fn an_input_is_never_overwritten() {
    let folder = Folder::new();
    let shape = folder.path("c.toml");
    write(&shape, "name = 'c'");
    let output = run(&["build", &shape, "--to", "json", "-o", &shape]).code(2);
    assert!(stderr(&output).contains("is an input"), "{}", stderr(&output));
    assert_eq!(read(&shape), b"name = 'c'");
}

#[test]
fn unreadable_files_are_status_3() {
    run(&["build", "shapes/missing.toml"]).code(3).stdout_eq("");
    run(&["measure", "shapes/missing.toml"]).code(3).stdout_eq("");
    run(&["build", "shapes", "--from", "shape"]).code(3).stdout_eq("");
}

#[cfg(unix)]
#[test]
fn devices_are_written_to_and_not_replaced() {
    run(&["build", BALL, "--to", "json", "-o", "/dev/null"]).code(0);
    let metadata = Path::new("/dev/null").metadata().expect("a device");
    assert!(!metadata.is_file());
}

#[cfg(unix)]
#[test]
fn new_files_get_the_usual_permissions_and_links_stay_links() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let (plain, real, link) = (folder.path("plain.txt"), folder.path("real.txt"), folder.path("link.txt"));
    write(&plain, "");
    write(&real, "");
    std::os::unix::fs::symlink(&real, &link).expect("a link");
    let made = folder.path("made.txt");
    run(&["build", BALL, "-o", &made, "-o", &link]).code(0);
    let mode = |path: &str| Path::new(path).metadata().expect("there").permissions().mode();
    assert_eq!(mode(&made), mode(&plain));
    assert!(Path::new(&link).is_symlink());
    assert_eq!(read(&real), read(&made));
}

#[test]
fn a_closed_pipe_ends_quietly() {
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_picot"))
        .args(["build", "shapes/paper/d.toml", "--to", "json", "-q"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("runs");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("ends");
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}

#[test]
fn color_only_where_it_is_wanted() {
    let bad = ["build", "shapes/missing.toml"];
    let escape = '\u{1b}';
    assert!(!stderr(&run(&bad)).contains(escape));
    assert!(stderr(&run(&[&bad[..], &["--color", "always"]].concat())).contains(escape));
    let forced = |no_color| picot(&bad).env("CLICOLOR_FORCE", "1").env("NO_COLOR", no_color).assert();
    assert!(stderr(&forced("")).contains(escape));
    assert!(!stderr(&picot(&bad).env("NO_COLOR", "1").assert()).contains(escape));
    assert!(!stderr(&run(&[&bad[..], &["--color", "never"]].concat())).contains(escape));
}

#[test]
fn dump_shows_a_level() {
    assert!(stdout(&run(&["build", BALL, "--dump", "graph"]).code(0)).contains("nodes"));
    assert!(stdout(&run(&["build", BALL, "--dump", "pattern"]).code(0)).contains("rows"));
}

#[test]
fn timings_name_the_stages() {
    let output = run(&["build", BALL, "--timings"]).code(0);
    for stage in ["read", "trace", "passes", "verify", "emit", "total"] {
        assert!(stderr(&output).contains(stage), "{}", stderr(&output));
    }
}

#[test]
fn gauge_on_the_command_line_takes_the_place_of_the_files() {
    let value = json(&["build", BALL, "--to", "json", "--gauge", "2mmx0.3cm"]);
    assert_eq!(value["gauge"]["width"], 2.0);
    assert_eq!(value["gauge"]["height"], 3.0);
}

fn json(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&stdout(&run(arguments).code(0))).expect("JSON")
}

#[test]
fn measure_has_every_field_of_its_schema() {
    for algorithm in ["picot", "paper", "capunaman"] {
        let value = json(&["measure", BALL, "--json", "--algorithm", algorithm]);
        assert_eq!(value["schema"], "picot.measure/1");
        assert_eq!(value["algorithm"], algorithm);
        for key in ["stitches", "rounds", "short_rows", "increases", "decreases", "coverage"] {
            assert!(value[key].is_number(), "{key}: {value:#}");
        }
        let error = &value["length_error"];
        for part in [error, &error["course"], &error["wale"]] {
            for kind in ["chord", "surface"] {
                for key in ["mean", "sd", "mean_abs", "rms", "p95"] {
                    assert!(part[kind][key].is_number(), "{kind} {key}: {value:#}");
                }
            }
        }
        for convention in ["all", "paper"] {
            for key in ["mean", "sd"] {
                assert!(value["skew"][convention][key].is_number(), "{value:#}");
            }
        }
        assert!(
            value["workable"].is_boolean() && value["time_ms"].is_object() && value["version"].is_string()
        );
    }
}

#[test]
fn measure_speaks_to_people_too() {
    let output = run(&["measure", BALL]).code(0);
    for word in ["length error", "skew", "coverage", "workable"] {
        assert!(stdout(&output).contains(word), "{}", stdout(&output));
    }
}

#[test]
fn bench_sets_the_papers_figures_beside_ours() {
    let folder = Folder::new();
    let file = folder.path("bench.json");
    let output = run(&["bench", "--paper", "--runs", "1", "--json", &file]).code(0);
    let text = stdout(&output);
    for words in ["Table 1", "Table 2", "Table 3", "columns are swapped", "stand in for"] {
        assert!(text.contains(words), "{text}");
    }
    let value: serde_json::Value = serde_json::from_slice(&read(&file)).expect("JSON");
    assert_eq!(value["schema"], "picot.bench/1");
    assert_eq!(value["cases"].as_array().map(Vec::len), Some(12));
}

#[test]
fn bench_tells_what_a_stitch_costs_by_size() {
    let text = stdout(&run(&["bench", "--scale", "1500", "--runs", "1"]).code(0));
    let rows =
        text.lines().filter(|line| line.split_whitespace().count() == 5 && !line.contains("us/stitch"));
    assert_eq!(rows.count(), 2, "{text}");
    let value = json(&["bench", "--scale", "1000", "--runs", "1", "--json", "-"]);
    assert_eq!(value["schema"], "picot.scale/1");
    let stitches = value["sizes"][0]["stitches"].as_u64().expect("a number");
    assert!((900..1_100).contains(&stitches), "{stitches}");
    let wrong = stderr(&run(&["bench", "--scale", "10"]).code(2));
    assert!(wrong.contains("1000"), "{wrong}");
}

#[test]
fn lists_have_text_and_json() {
    for topic in ["targets", "readers", "passes", "stitches", "codes"] {
        let value = json(&["list", topic, "--json"]);
        let rows = value[topic].as_array().expect("an array");
        assert!(!rows.is_empty(), "{topic}");
        let text = stdout(&run(&["list", topic]).code(0));
        assert!(text.lines().count() >= rows.len(), "{text}");
    }
}

#[test]
fn every_code_is_explained() {
    for code in picot::diag::Code::ALL {
        let page = stdout(&run(&["explain", &code.as_str().to_lowercase()]).code(0).stderr_eq(""));
        assert!(page.starts_with(code.as_str()), "{page}");
    }
}

#[test]
fn shells_and_man_accept_our_pages() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(stdout(&run(&["completions", shell]).code(0)).contains("picot"));
    }
    let script = stdout(&run(&["completions", "bash"]));
    let folder = Folder::new();
    write(folder.path("picot.bash"), &script);
    if let Ok(status) = std::process::Command::new("bash").args(["-n", &folder.path("picot.bash")]).status() {
        assert!(status.success());
    }
    assert!(stdout(&run(&["man"]).code(0)).contains(".TH picot 1"));
    assert!(stdout(&run(&["man", "build"]).code(0)).contains("picot\\-build"));
    run(&["man", "buidl"]).code(2);
}
