//! The open ends of a row: how often `around` goes, and what it says when that does not come out even.

use super::effect::{self, Effect};
use super::lex::At;
use super::lower::{Site, Trouble};
use crate::diag::Code;
use crate::ir::{Block, Direction, MAX_ROW, Op, Stitch};

/// Closes the open end of a row. `spaces` are those that the row goes into without it, and those of the row below.
pub(crate) fn close(
    block: &mut Block,
    site: Site,
    have: Option<i64>,
    spaces: (Option<u32>, Option<u32>),
    stated: Option<u32>,
) -> Result<(), Trouble> {
    let trouble = |code, message: String| Trouble::new(code, site.at, message);
    let limit = || Trouble::new(Code::Limit, site.at, "the numbers multiply to too many loops");
    let effect =
        |block: &Block, direction: &mut Direction| effect::of(block, direction, false).map_err(|_| limit());
    let mut direction = Direction::Forward;
    let after_block = block.split_off(site.index);
    let before = effect(block, &mut direction)?;
    let mut inside = direction;
    let pass = effect(&site.body, &mut inside)?;
    if inside != direction {
        return Err(trouble(Code::UnbalancedTurn, "a repeat that turns and does not turn back".into()));
    }
    let mut rest_direction = direction;
    let after = effect(&after_block, &mut rest_direction).unwrap_or_default();
    let rest = before.then(after).ok_or_else(limit)?.works();
    let partial = match &site.partial {
        Some(partial) => effect(partial, &mut inside)?.works(),
        None => 0,
    };
    if let Some(last) = site.last {
        let behind = after.works();
        let wanted = i64::from(last.value);
        if behind != wanted {
            let code = if behind > wanted { Code::LoopsExhausted } else { Code::LoopsLeft };
            return Err(Trouble::new(
                code,
                last.at,
                format!("{wanted} loops are kept back, and the row goes on over {behind}"),
            ));
        }
    }
    let Some(have) = have else {
        return Err(trouble(
            Code::NotChecked,
            "how often this is repeated cannot be told: the loops below are not known".into(),
        ));
    };
    let per = pass.works();
    if let Some((stitch, count)) = site.even {
        return even(block, after_block, &site, have - rest, stitch, count);
    }
    let times = if per <= 0 {
        // A repeat into chain spaces goes by place; only its count can tell how often.
        match by_place(&site, spaces) {
            Some(times) if stated.is_none() => i64::from(times),
            _ => by_count(&site, before.behind + after.behind, pass, spaces.0.is_some(), stated)?,
        }
    } else {
        let room = have - rest - partial;
        if room < 0 || room % per != 0 || (room == 0 && site.partial.is_none()) {
            return Err(indivisible(site.at, have, rest + partial, per));
        }
        room / per
    };
    let times = u32::try_from(times).ok().filter(|times| *times <= MAX_ROW).ok_or_else(limit)?;
    let span = site.body.spanned().next().map(|(_, span)| span).unwrap_or_default();
    if times == 1 {
        block.append(site.body);
    } else if times > 1 {
        match site.body.ops() {
            [Op::Work { stitch, times: once }] if once.checked_mul(times).is_some() => {
                block.push(Op::Work { stitch: *stitch, times: once * times }, span);
            }
            _ => block.push(Op::repeat(site.body, times), span),
        }
    }
    if let Some(partial) = site.partial {
        block.append(partial);
    }
    block.append(after_block);
    Ok(())
}

fn even(
    block: &mut Block,
    after: Block,
    site: &Site,
    room: i64,
    stitch: Stitch,
    count: u32,
) -> Result<(), Trouble> {
    let plain = room - i64::from(stitch.works) * i64::from(count);
    let base = match site.body.ops() {
        [Op::Work { stitch, .. }] => *stitch,
        _ => Stitch::SC,
    };
    let Some(plain) = u32::try_from(plain).ok().filter(|plain| *plain <= MAX_ROW) else {
        let message = format!(
            "{count} of these need {} loops, {room} are there",
            i64::from(stitch.works) * i64::from(count)
        );
        return Err(Trouble::new(Code::LoopsExhausted, site.at, message));
    };
    let span = site.body.spanned().next().map(|(_, span)| span).unwrap_or_default();
    super::stitches::spread(base, plain, stitch, count, span, block);
    block.append(after);
    Ok(())
}

/// Passes of a repeat that goes into chain spaces, when those of the row below come out even.
fn by_place(site: &Site, (own, below): (Option<u32>, Option<u32>)) -> Option<u32> {
    let room = below?.checked_sub(own?)?;
    let times = room.checked_div(site.spaces)?;
    (times > 0 && times * site.spaces == room).then_some(times)
}

/// Passes of a repeat beside which the row makes `fixed` loops, when it goes into chain spaces and states its count.
fn by_count(
    site: &Site,
    fixed: i64,
    pass: Effect,
    in_spaces: bool,
    stated: Option<u32>,
) -> Result<i64, Trouble> {
    let room = stated.map(|stated| i64::from(stated) - fixed);
    match room {
        Some(room) if in_spaces && pass.behind > 0 && room > 0 && room % pass.behind == 0 => {
            Ok(room / pass.behind)
        }
        Some(room) if in_spaces && pass.behind > 0 => Err(Trouble::new(
            Code::CountDiffers,
            site.at,
            format!("a repeat that makes {} each time cannot make {room}", pass.behind),
        )),
        _ => Err(Trouble::new(Code::TwoFills, site.at, "a repeat that works no loop never comes to an end")
            .help("say how often it is worked, or state the count")),
    }
}

/// `fits 1 + a multiple of 4 (21 or 25); there are 24 loops`.
fn indivisible(at: At, have: i64, rest: i64, per: i64) -> Trouble {
    let lower = rest + (have - rest).max(0) / per * per;
    let (low, high) = (lower.max(rest + per), lower.max(rest) + per);
    let near = if low == high || lower <= rest { format!("{high}") } else { format!("{low} or {high}") };
    let fits = match (rest, per) {
        (0, 2) => format!("an even count ({near})"),
        (0, _) => format!("a multiple of {per} ({near})"),
        _ => format!("{rest} + a multiple of {per} ({near})"),
    };
    Trouble::new(Code::Indivisible, at, format!("fits {fits}; there are {have} loops")).help(format!(
        "change the row below to make {near}, or work the {} loops left over one by one",
        (have - rest).rem_euclid(per)
    ))
}
