//! A row that does not fit: what is said about it, what probably caused it, and what would mend it.

use super::blame::{self, Cure, Verdict, Way};
use super::check::{Checker, State};
use super::conventions::Setting;
use super::lex::At;
use super::lower::{Below, Place0, Trouble};
use super::plan::{Item, Part, What};
use super::solve::{Job, Solved};
use super::syntax::RowKind;
use crate::diag::{Code, Diagnostic, Edit, Fix};

/// Most faults of a file whose causes are searched.
const MAX_SEARCHED: usize = 200;

impl Checker<'_> {
    /// Reports a faulty row once, and says how many loops the next one starts from.
    pub(super) fn fault(
        &mut self,
        part: &Part<'_>,
        index: usize,
        job: &Job<'_>,
        outcome: Result<&Solved, &Trouble>,
        state: &State,
    ) -> Option<i64> {
        let item = part.items.get(index)?;
        let trouble = match outcome {
            Ok(solved) => solved.fault.as_deref()?,
            Err(trouble) => trouble,
        };
        let stated = job.count.and_then(super::gather::stated).map(|n| i64::from(n.value));
        let made = outcome.ok().map(|solved| solved.leaves(part.flat));
        let counts = matches!(
            trouble.code,
            Code::LoopsExhausted | Code::LoopsLeft | Code::CountDiffers | Code::ChainLength
        );
        if !counts || self.found.len() > MAX_SEARCHED {
            let found = self.describe(part, item, trouble, job, outcome, state);
            self.say(found, trouble.at, "");
            return self.after(stated, made, stated.or(made));
        }
        let before = index.checked_sub(1).and_then(|index| part.items.get(index));
        let before_body = match before.map(|item| item.what) {
            Some(What::Row(row) | What::Again(row, _)) => Some(row.body.of(self.file.nodes)),
            _ => None,
        };
        let conventions = self.conventions;
        let ways: Vec<Way> = blame::ways(job, before_body, conventions, &mut self.colors);
        let verdict = {
            let colors = &mut self.colors;
            let file = self.file;
            let mut onward = |loops: i64| onward(part, index, loops, conventions, file, colors, state);
            blame::judge(&ways, &mut onward)
        };
        let earlier = self.earlier_cause(part, index, outcome, &verdict, state);
        let mut found = self.describe(part, item, trouble, job, outcome, state);
        if let Some((message, at, round)) = earlier {
            found.message = message;
            found.labels.clear();
            found = found.in_round(&part.name, round);
            let name = name(item);
            let span = self.document.source.span(trouble.at.range());
            found = found
                .at(self.document.source.span(at.range()), "most likely here")
                .at(span, format!("{name} does not fit it"));
            found.help = None;
            self.found.push(found);
            let leaves = outcome.ok().map(|solved| solved.makes);
            return self.after(stated, made, stated.or(leaves));
        }
        let at = self.cure(&mut found, &verdict, job, trouble);
        self.say(found, at, "");
        self.after(stated, made, verdict.leaves)
    }

    fn after(&self, stated: Option<i64>, made: Option<i64>, best: Option<i64>) -> Option<i64> {
        match self.conventions.get(Setting::AfterFault) {
            "stated" => stated.or(made),
            "made" => made.or(stated),
            _ => best.or(stated).or(made),
        }
    }

    /// The finding without its causes.
    fn describe(
        &self,
        part: &Part<'_>,
        item: &Item<'_>,
        trouble: &Trouble,
        job: &Job<'_>,
        outcome: Result<&Solved, &Trouble>,
        state: &State,
    ) -> Diagnostic {
        let verb =
            ["works ", "makes ", "runs ", "fits "].iter().any(|verb| trouble.message.starts_with(verb));
        let message =
            if verb { format!("{} {}", name(item), trouble.message) } else { trouble.message.clone() };
        let mut found = Diagnostic::new(trouble.code, message).in_round(&part.name, item.first);
        let span = |at: At| self.document.source.span(at.range());
        if let (Ok(solved), Some(count)) = (outcome, job.count)
            && let Some(stated) = solved.stated
            && count.total.at != trouble.at
        {
            found = found.at(span(count.total.at), format!("{stated} stated, {} made", solved.makes));
        }
        let uses_below = matches!(
            trouble.code,
            Code::LoopsExhausted | Code::LoopsLeft | Code::Indivisible | Code::CountDiffers
        );
        if let (Some(at), Some(have), true) =
            (state.last_at, job.have, uses_below && state.below != Below::Nothing)
        {
            found = found.at(span(at), format!("this leaves {have}"));
        }
        if let Some(help) = &trouble.help {
            found = found.help(help.clone());
        }
        found
    }

    /// Adds the likeliest cure; returns where to look.
    fn cure(&self, found: &mut Diagnostic, verdict: &Verdict, job: &Job<'_>, trouble: &Trouble) -> At {
        let span = |at: At| self.document.source.span(at.range());
        match &verdict.cure {
            Cure::Stated { at, count } => {
                found.help = Some(format!("the row makes {count}: write {count}, or change the row"));
                found.fixes.push(Fix {
                    title: format!("state {count}"),
                    edits: vec![Edit { span: span(*at), replacement: count.to_string() }],
                    certain: verdict.certain,
                });
                *at
            }
            Cure::Number { at, from, to } => {
                found.help = Some(format!("`{from}` → `{to}` fits"));
                found.fixes.push(Fix {
                    title: format!("write {to}"),
                    edits: vec![Edit { span: span(*at), replacement: to.to_string() }],
                    certain: verdict.certain,
                });
                *at
            }
            Cure::Missing { works } if trouble.code != Code::CountDiffers => {
                let have = job.have.unwrap_or(0);
                found.help = Some(format!("a round from {have} to {works} loops may be missing before it"));
                trouble.at
            }
            Cure::Doubled => {
                found.help = Some("the same row stands before it: it may be there twice".to_owned());
                trouble.at
            }
            Cure::Flip(at) => {
                found.help = Some("`inc` and `dec` exchanged here would fit".to_owned());
                *at
            }
            Cure::Missing { .. } | Cure::None | Cure::Unknown => trouble.at,
        }
    }

    /// A row before this one that no count vouches for, and that one change would make fit.
    fn earlier_cause(
        &mut self,
        part: &Part<'_>,
        index: usize,
        outcome: Result<&Solved, &Trouble>,
        verdict: &Verdict,
        state: &State,
    ) -> Option<(String, At, Option<u32>)> {
        let solved = outcome.ok()?;
        let wanted = solved.works + solved.left;
        let own = solved.stated.is_none_or(|stated| i64::from(stated) == solved.makes);
        if !own || solved.lowered.site.is_some() || wanted <= 0 || state.rows.is_empty() {
            return None;
        }
        // A cure of this row that its own count vouches for is likelier.
        if solved.stated.is_some() && matches!(verdict.cure, Cure::Number { .. } | Cure::Stated { .. }) {
            return None;
        }
        let before = part.items.get(index.checked_sub(1)?)?;
        let What::Row(row) = before.what else { return None };
        if row.count.is_some() || before.times() > 1 {
            return None;
        }
        let below = state.rounds.iter().rev().nth(1).and_then(|round| round.produces).map(i64::from)?;
        let item = part.items.get(index)?;
        let place = Place0 { below: Below::Loops, ..self.place(part, state) };
        let job = Job {
            body: row.body.of(self.file.nodes),
            count: None,
            at: before.at,
            file: self.file,
            place: &place,
            have: Some(below),
        };
        let at = blame::number_for(&job, wanted, self.conventions, &mut self.colors)?;
        let made = solved.have?;
        let message = format!("{} makes {made} loops, {} works {wanted}", name(before), name(item));
        Some((message, at, before.first))
    }
}

/// `round 6`, `row 6`.
fn name(item: &Item<'_>) -> String {
    let kind = if item.label.is_some_and(|label| label.kind == RowKind::Row) { "row" } else { "round" };
    match item.first {
        Some(first) => format!("{kind} {first}"),
        None => "this row".to_owned(),
    }
}

/// What the next two rows cost when they start from so many loops.
fn onward(
    part: &Part<'_>,
    index: usize,
    loops: i64,
    conventions: &super::Conventions,
    file: &super::lower::File<'_>,
    colors: &mut Vec<String>,
    state: &State,
) -> Vec<u32> {
    let mut costs = Vec::new();
    let mut loops = loops;
    for item in part.items.iter().skip(index + 1).take(2) {
        let What::Row(row) = item.what else { break };
        let place = Place0 {
            below: Below::Loops,
            flat: part.flat,
            joined: part.joined,
            chain_counted: false,
            dominant: state.dominant,
            spaces: None,
            beyond: 0,
            color: None,
            segments: &[],
        };
        let job = Job {
            body: row.body.of(file.nodes),
            count: row.count.as_ref(),
            at: item.at,
            file,
            place: &place,
            have: Some(loops),
        };
        let (cost, leaves) = blame::cost(&job, conventions, colors);
        costs.push(cost);
        loops = leaves;
    }
    costs
}
