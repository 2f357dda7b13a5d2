//! The option `readability`: pleasant words for a little fidelity.

use super::command::{Folder, run, stderr, stdout};
use super::maker::{at, make};
use super::snapshots::shapes;
use picot::Options;
use picot::metrics::Readability;

fn with(readability: f64) -> Options {
    let mut options = Options::default();
    options.generate.readability = Some(readability);
    options
}

#[test]
fn words_get_fewer_and_the_shape_stays() {
    const ASYMMETRIC: [&str; 9] =
        ["bear", "cactus", "cane", "horn", "mitten", "paper-b", "paper-c", "paper-d", "snake"];
    let mut words = [0.0; 3];
    let mut length = [0.0; 3];
    let mut equal = [0.0; 3];
    for (_, path) in shapes().into_iter().filter(|(name, _)| ASYMMETRIC.contains(&name.as_str())) {
        let shape = at(&path);
        for (index, value) in [0.0, 0.5, 1.0].into_iter().enumerate() {
            // Each is worked loop by loop.
            let program = make(&shape, &with(value));
            let read = Readability::of(&program.pattern, &program.graphs);
            words[index] += read.words_per_stitch;
            equal[index] += read.equal_rounds;
            let measure = picot::measure(&shape, &program);
            length[index] += measure.length_error.chord.mean_abs;
            assert!(measure.length_error.chord.mean_abs < 0.09, "{} at {value}", shape.name);
            assert!(measure.inverted_tiles <= 2, "{} at {value}: {}", shape.name, measure.inverted_tiles);
        }
    }
    assert!(words[1] < 0.92 * words[0] && words[2] < 0.97 * words[1], "{words:?}");
    assert!(equal[0] < equal[1] && equal[1] < equal[2], "{equal:?}");
    assert!(length[1] < 1.12 * length[0] && length[2] < 1.3 * length[0], "{length:?}");
}

#[test]
fn increases_keep_clear_of_those_below() {
    // Those that are not here have even rounds, of which some leave no room.
    const CLEAR: [&str; 20] = [
        "ball", "bear", "beastie", "cactus", "cane", "cat", "elbow", "goose", "horn", "mitten", "octopus",
        "paper-a", "paper-b", "paper-c", "paper-d", "paper-e", "snake", "trousers", "vase", "worm",
    ];
    let mut increases = 0;
    for (name, path) in shapes() {
        let program = make(&at(&path), &Options::default());
        let read = Readability::of(&program.pattern, &program.graphs);
        assert!(read.stacked_by_choice <= read.stacked_increases + 1e-9, "{name}");
        let most = if CLEAR.contains(&name.as_str()) { 0.05 } else { 0.4 };
        assert!(read.stacked_by_choice < most, "{name}: {}", read.stacked_by_choice);
        increases += usize::from(read.stacked_increases > 0.0 && read.stacked_by_choice == 0.0);
    }
    assert!(increases > 5, "around a magic ring there is no other place");
}

#[test]
fn nothing_said_is_zero() {
    for (name, path) in shapes().into_iter().filter(|(name, _)| ["paper-c", "vase"].contains(&name.as_str()))
    {
        let shape = at(&path);
        assert_eq!(make(&shape, &with(0.0)), make(&shape, &Options::default()), "{name}");
    }
}

#[test]
fn short_rows_are_plain() {
    let (_, path) = shapes().into_iter().find(|(name, _)| name == "elbow").expect("shipped");
    let shape = at(&path);
    let shaped = |value: f64| {
        let program = make(&shape, &with(value));
        let back = |tile: &&picot::ir::Tile| tile.direction == picot::ir::Direction::Back;
        let tiles = program.graphs[0].tiles.iter().filter(back);
        tiles.filter_map(|tile| tile.stitch).filter(|stitch| stitch.works != stitch.makes).count()
    };
    let (before, after) = (shaped(0.0), shaped(1.0));
    assert!(after * 3 < before, "{before} and {after}");
}

#[test]
fn the_command_line_and_the_file_ask_for_it() {
    let folder = Folder::new();
    let c = "shapes/paper/c.toml";
    let file = folder.file(
        "c.toml",
        super::tidy::text(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(c).as_path())
            + "\n[maker]\nreadability = 1.0\n",
    );
    let text = |arguments: &[&str]| stdout(&run(arguments).success());
    let simple = text(&["build", &file]);
    assert_eq!(simple, text(&["build", c, "--set", "readability=1"]));
    assert_ne!(simple, text(&["build", c]));
    assert_eq!(text(&["build", &file, "--set", "readability=0"]), text(&["build", c]));
    let wrong = stderr(&run(&["build", c, "--set", "readability=2"]).code(2));
    assert!(wrong.contains("readability") && wrong.contains("from 0 to 1"), "{wrong}");
}

#[test]
fn anyone_can_renew_the_table() {
    let table =
        stdout(&run(&["bench", "--readability", "shapes/paper/c.toml", "shapes/cylinder.toml"]).success());
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with("| 0") || line.starts_with("| 1"))
        .map(|line| line.split('|').map(str::trim).collect())
        .collect();
    assert_eq!(rows.len(), 5, "{table}");
    let words = |row: &[&str]| row[2].parse::<f64>().expect("a number");
    assert!(words(&rows[4]) < words(&rows[0]), "{table}");
}
