//! What may stand on the command line: types for clap, and nothing that acts.

use clap::builder::PossibleValuesParser;
use clap::{Args, Parser, Subcommand, ValueEnum};
use picot::backends::TARGETS;
use picot::frontend::mesh::Up;
use picot::frontend::{READERS, Unit};
use picot::ir::Gauge;

const EXAMPLES: &str = "\
Examples:
  picot build shapes/ball.toml                    print the pattern
  picot build shapes/ball.toml -o ball.txt -o ball.json
";

const PREVIEWS: &str = "\
Examples:
  picot preview shapes/ball.toml -o ball.png
  picot preview frog.txt -o frog.png                       a written pattern; its shape is predicted
  picot preview goose.toml -o goose.png --set view=wireframe --set size=1600x1200 --set azimuth=80";

/// Compiles 3D shapes to textile instructions.
#[derive(Debug, Parser)]
#[command(name = "picot", version, arg_required_else_help = true, after_help = EXAMPLES, max_term_width = 100)]
pub(crate) struct Cli {
    #[command(flatten)]
    pub(crate) global: Global,
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What every command takes.
#[derive(Debug, Args)]
pub(crate) struct Global {
    /// Color in messages
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto", hide_possible_values = true)]
    pub(crate) color: Color,
    /// Only errors and warnings on stderr
    #[arg(short, long, global = true)]
    pub(crate) quiet: bool,
}

/// When messages have color.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Color {
    /// On a terminal, unless `NO_COLOR` is set.
    Auto,
    /// Also into files and pipes.
    Always,
    /// Never.
    Never,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Compile a shape to a pattern and other outputs
    Build(Build),
    /// Draw what comes out
    #[command(after_help = PREVIEWS)]
    Preview(Build),
    /// Check patterns and machine programs
    Check(Check),
    /// Rewrite written patterns in canonical form
    Fmt(Fmt),
    /// Measure how close the stitches come to the shape
    Measure(Measure),
    /// Write the surface of a shape: OBJ for modeling tools, loops, or what is found in a mesh as a shape file
    Surface(Surface),
    /// Time the compiler; with --paper, set it beside the tables of the paper
    Bench(Bench),
    /// List what there is: targets, readers, passes, stitches, diagnostic codes
    List(List),
    /// Explain a diagnostic, such as E0101
    Explain(Explain),
    /// Print the completion script of a shell
    Completions(Completions),
    /// Print the manual page
    Man(Man),
}

/// How inputs are read; for every command with an input.
#[derive(Debug, Args)]
pub(crate) struct Reading {
    /// Format of the input, where its extension does not tell
    #[arg(long, value_name = "READER", value_parser = readers())]
    pub(crate) from: Option<String>,
    /// Stitch size in place of the file's own, such as 2.5mmx2.5mm
    #[arg(long, value_name = "WxH", value_parser = gauge)]
    pub(crate) gauge: Option<Gauge>,
    /// Unit of a mesh that is given directly: mm, cm or in
    #[arg(long, value_name = "UNIT", value_parser = word(Unit::WORDS))]
    pub(crate) unit: Option<String>,
    /// Axis of such a mesh that points up: x, y or z
    #[arg(long, value_name = "AXIS", value_parser = word(Up::WORDS))]
    pub(crate) up: Option<String>,
    /// Machine: a name of `picot list machines`, or a profile file; one of kind `hand` bounds the pattern itself
    #[arg(long, value_name = "NAME")]
    pub(crate) machine: Option<String>,
    /// Make the pattern for a left-handed maker; the same as --set hand=left
    #[arg(long)]
    pub(crate) left_handed: bool,
    /// Set an option of the generator or of a target (`picot list targets` shows the keys)
    #[arg(long, value_name = "KEY=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, toml::Value)>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  picot build shapes/ball.toml                    print the pattern
  picot build a.toml b.toml --to json -o out/     one file for each input
  cat ball.toml | picot build - --from shape -o ball.txt")]
pub(crate) struct Build {
    /// Shape files or patterns; `-` is stdin
    #[arg(required = true, value_name = "INPUT")]
    pub(crate) inputs: Vec<String>,
    /// Target, where the extension of the output does not tell
    #[arg(long, value_name = "TARGET", value_parser = targets())]
    pub(crate) to: Vec<String>,
    /// Output file; `-` is stdout, and a directory takes one file for each input and target
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Vec<String>,
    #[command(flatten)]
    pub(crate) reading: Reading,
    /// Print a level of the compiler instead of a target
    #[arg(long, value_name = "LEVEL", conflicts_with_all = ["to", "output"])]
    pub(crate) dump: Option<Level>,
    /// Print how long each stage took
    #[arg(long)]
    pub(crate) timings: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  picot check ball.xml sleeve.k
  picot check frog.txt --set star-times=more      with a convention of this maker
  picot check --fix frog.txt                      apply the repairs that are beyond doubt
  picot check sleeve.kc --machine kniterate --against sleeve.toml")]
pub(crate) struct Check {
    /// Written patterns, Picot XML, `.k` or `.kc`; `-` is stdin
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<String>,
    /// Form of the findings
    #[arg(long, value_name = "FORMAT", default_value = "human")]
    pub(crate) format: CheckFormat,
    /// A shape or pattern whose loops a machine program must make, one by one
    #[arg(long, value_name = "INPUT")]
    pub(crate) against: Option<String>,
    /// Apply the repairs of written patterns that are beyond doubt
    #[arg(long)]
    pub(crate) fix: bool,
    #[command(flatten)]
    pub(crate) reading: Reading,
}

#[derive(Debug, Args)]
pub(crate) struct Fmt {
    /// Written patterns; `-` is stdin to stdout
    #[arg(required = true, value_name = "FILE")]
    pub(crate) files: Vec<String>,
    /// Write nothing; name the files that would change, and exit with 1 if there are any
    #[arg(long)]
    pub(crate) check: bool,
    #[command(flatten)]
    pub(crate) reading: Reading,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  picot surface shapes/paper/d.toml -o d.obj
  picot surface shapes/cactus.toml --part trunk -o trunk.loops
  picot surface duck.obj --gauge 5mmx5mm -o duck.toml")]
pub(crate) struct Surface {
    /// Shape file, mesh or loops; `-` is stdin
    #[arg(value_name = "INPUT")]
    pub(crate) input: String,
    /// Output file: .obj or .loops; .toml for what is found in a mesh
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: String,
    /// The part to write as loops, where there are several
    #[arg(long, value_name = "NAME")]
    pub(crate) part: Option<String>,
    #[command(flatten)]
    pub(crate) reading: Reading,
}

/// Form of findings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CheckFormat {
    /// With the lines of the file, on stderr.
    Human,
    /// One line each, on stdout.
    Short,
    /// On stdout, for programs.
    Json,
}

/// A level of the compiler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Level {
    /// Where each stitch lies.
    Graph,
    /// What the hook does.
    Pattern,
}

#[derive(Debug, Args)]
pub(crate) struct Measure {
    /// Shape file; `-` is stdin
    #[arg(value_name = "INPUT")]
    pub(crate) input: String,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
    /// Who lays the stitches
    #[arg(long, value_name = "NAME", default_value = "picot")]
    pub(crate) algorithm: Algorithm,
    /// Settle the stitches of the paper or the baseline on the surface first, as our own are
    #[arg(long)]
    pub(crate) relaxed: bool,
    /// Predict the shape from the pattern alone, and tell how far it is from the target
    #[arg(long)]
    pub(crate) predict: bool,
    #[command(flatten)]
    pub(crate) reading: Reading,
}

/// An algorithm that lays stitches on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Algorithm {
    /// Our own.
    Picot,
    /// The paper's, built from its text.
    Paper,
    /// The baseline of the paper's tables (Çapunaman, Bingöl and Gürsoy 2017).
    Capunaman,
}

#[derive(Debug, Args)]
pub(crate) struct Bench {
    /// Print the paper's Tables 1 to 3 beside our numbers
    #[arg(long)]
    pub(crate) paper: bool,
    /// Instead print what the option `readability` does to the patterns of these shape files
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with = "paper")]
    pub(crate) readability: Vec<String>,
    /// Instead print the time of a stitch by the size of the whole, up to so many stitches: 10000000 where none are given
    #[arg(long, value_name = "STITCHES", num_args = 0..=1, default_missing_value = "10000000",
        value_parser = clap::value_parser!(u32).range(1_000..=10_000_000), conflicts_with_all = ["paper", "readability"])]
    pub(crate) scale: Option<u32>,
    /// Write all numbers to a file as JSON; `-` is stdout
    #[arg(long, value_name = "FILE")]
    pub(crate) json: Option<String>,
    /// Runs of each case, of which the median counts (20), or with `--scale` the least (5 turns)
    #[arg(long, conflicts_with = "readability", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub(crate) runs: Option<u32>,
}

#[derive(Debug, Args)]
pub(crate) struct List {
    /// What to list
    pub(crate) what: Topic,
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}

/// A table of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Topic {
    /// Output formats with their options.
    Targets,
    /// Input formats.
    Readers,
    /// Passes over a pattern, in order.
    Passes,
    /// Stitches in US and UK terms.
    Stitches,
    /// Knitting machines, and every field of a machine profile.
    Machines,
    /// Diagnostic codes.
    Codes,
    /// Conventions of written patterns.
    Conventions,
}

#[derive(Debug, Args)]
pub(crate) struct Explain {
    /// The code of a diagnostic
    pub(crate) code: String,
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    pub(crate) shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// A command; without it the page of picot itself
    pub(crate) command: Option<String>,
}

fn targets() -> PossibleValuesParser {
    PossibleValuesParser::new(TARGETS.iter().map(|target| target.name))
}

fn readers() -> PossibleValuesParser {
    PossibleValuesParser::new(READERS.iter().map(|reader| reader.name))
}

fn word<T>(words: &'static [(&'static str, T)]) -> PossibleValuesParser {
    PossibleValuesParser::new(words.iter().map(|(word, _)| *word))
}

fn setting(text: &str) -> Result<(String, toml::Value), String> {
    picot::settings::parse(text).ok_or_else(|| "expected KEY=VALUE".to_owned())
}

/// Reads a stitch size such as `2.5mmx2.5mm`; a bare number is in mm.
fn gauge(text: &str) -> Result<Gauge, String> {
    let wrong = || "expected WIDTHxHEIGHT, for example 2.5mmx2.5mm".to_owned();
    let (width, height) = text.split_once(['x', 'X', '×']).ok_or_else(wrong)?;
    let length = |text: &str| {
        let text = text.trim();
        let units = [("mm", 1.0), ("cm", 10.0), ("in", 25.4)];
        let (number, unit) =
            units.iter().find_map(|(unit, mm)| Some((text.strip_suffix(unit)?, *mm))).unwrap_or((text, 1.0));
        let length = number.trim_end().parse::<f64>().ok()? * unit;
        (length.is_finite() && length > 0.0).then_some(length)
    };
    Ok(Gauge::new(length(width).ok_or_else(wrong)?, length(height).ok_or_else(wrong)?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauge_reads_units_and_refuses_what_is_no_size() {
        assert_eq!(gauge("2.5mmx2.5mm"), Ok(Gauge::new(2.5, 2.5)));
        assert_eq!(gauge("0.25cm x 1in"), Ok(Gauge::new(2.5, 25.4)));
        assert_eq!(gauge("2×3"), Ok(Gauge::new(2.0, 3.0)));
        for text in ["", "2.5mm", "0x1", "-1x1", "nanx1", "infx1", "1x", "1 kmx1"] {
            assert!(gauge(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_command_line_is_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
