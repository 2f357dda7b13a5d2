//! From a surface to a stitch graph: rows, first row, shaping, short rows and relaxation.

use crate::diag::Sink;
use crate::ir::{Gauge, Graph};
use crate::shape::Tube;

/// What the generator may be told.
#[derive(Clone, Debug, PartialEq, Default, serde::Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub struct Options {}

/// The stitch graph of one tube; `None` with the reason in the sink when it cannot be made.
pub fn generate(_tube: &Tube, _gauge: &Gauge, _options: &Options, _sink: &mut Sink<'_>) -> Option<Graph> {
    None
}
