//! What a maker should know about a scene.

use super::Scene;
use super::predict::Rest;
use crate::diag::{Code, Diagnostic, Sink};

impl Scene {
    /// Where the places of the stitches are from, in a word.
    pub fn origin(&self) -> &'static str {
        match self.predicted {
            None => "target",
            Some(Rest { converged: true, .. }) => "predicted",
            Some(Rest { converged: false, .. }) => "unconverged",
        }
    }

    /// Tells the sink what is assumed or predicted, once a run.
    pub fn remark(&self, sink: &mut Sink<'_>) {
        let mut tell = |code: Code, message: String, help: &str| {
            if !sink.diagnostics().iter().any(|told| told.code == code) {
                sink.push(Diagnostic::new(code, message).help(help));
            }
        };
        if self.gauge_assumed {
            let [width, height] = self.gauge;
            let message = format!("drawn with stitches of {width} mm x {height} mm");
            tell(Code::GaugeAssumed, message, "name your own with `--gauge`, such as `--gauge 4.5mmx4mm`");
        }
        match self.predicted {
            Some(Rest { converged: true, strain, .. }) => {
                let message =
                    format!("predicted from the stitches alone, which stretch by {:.1} %", 100.0 * strain);
                tell(Code::Predicted, message, "a shape file is drawn as designed");
            }
            Some(Rest { residual, steps, .. }) => {
                let message = format!("forces of {residual:.1e} are left after {steps} steps");
                tell(Code::NotAtRest, message, "take the picture as a rough one");
            }
            None => {}
        }
    }
}
