//! The deque of open loops, written down a second time: an oracle for the verifier.

use picot::ir::{Direction, Step, Stitch};
use std::collections::VecDeque;

/// Loops that a turn takes on either side; the tiles of the paper take one each, a plain turn none.
pub(crate) type Cost = (usize, usize);

/// What cannot be worked.
#[derive(Debug, PartialEq)]
pub(crate) enum Fault {
    Underflow(usize),
    Turn(usize),
}

/// Loops that are open after the steps.
pub(crate) fn simulate(start: u32, steps: &[Step], (far, near): Cost) -> Result<usize, Fault> {
    let mut ring: VecDeque<u32> = (0..start).collect();
    let mut next = start;
    // Tops that the far side of a turn left, and those of the back pass; present while working back.
    let mut back: Option<(Vec<u32>, Vec<u32>)> = None;
    let mut make = || {
        next += 1;
        next - 1
    };
    for (index, step) in steps.iter().enumerate() {
        let under = Fault::Underflow(index);
        match *step {
            Step::Work(stitch) => {
                for _ in 0..stitch.works {
                    let popped = if back.is_some() { ring.pop_back() } else { ring.pop_front() };
                    if popped.is_none() {
                        return Err(under);
                    }
                }
                for _ in 0..stitch.makes {
                    match &mut back {
                        Some((_, tops)) => tops.push(make()),
                        None => ring.push_back(make()),
                    }
                }
            }
            Step::Turn(Direction::Back) => {
                if back.is_some() {
                    return Err(Fault::Turn(index));
                }
                if ring.len() < far {
                    return Err(under);
                }
                ring.drain(..far);
                back = Some(((0..far).map(|_| make()).collect(), Vec::new()));
            }
            Step::Turn(Direction::Forward) => {
                let (held, tops) = back.take().ok_or(Fault::Turn(index))?;
                if ring.len() < near {
                    return Err(under);
                }
                ring.truncate(ring.len() - near);
                ring.extend((0..near).map(|_| make()));
                for top in held.into_iter().rev() {
                    ring.push_front(top);
                }
                for top in tops {
                    ring.push_front(top);
                }
            }
            Step::Hold { loops, .. } => {
                if ring.len() < loops as usize {
                    return Err(under);
                }
                ring.drain(..loops as usize);
            }
            Step::Leave { .. } | Step::Color(_) => {}
        }
    }
    Ok(ring.len())
}

/// Steps from words: `8` are single crochets, `d` and `i` a decrease and an increase, `<` and `>` turns.
fn steps(words: &str) -> Vec<Step> {
    let word = |word: &str| match word {
        "<" => vec![Step::Turn(Direction::Back)],
        ">" => vec![Step::Turn(Direction::Forward)],
        "d" => vec![Step::Work(Stitch::DEC)],
        "i" => vec![Step::Work(Stitch::INC)],
        count => vec![Step::Work(Stitch::SC); count.parse().expect("a number")],
    };
    words.split_whitespace().flat_map(word).collect()
}

#[test]
fn plain_and_bridged_turns_keep_the_count() {
    let plain = steps("8 < 6 > 6 4");
    assert_eq!(plain.iter().filter(|step| matches!(step, Step::Work(_))).count(), 24);
    assert_eq!(simulate(12, &plain, (0, 0)), Ok(12));
    assert_eq!(simulate(12, &steps("7 < 5 > 6 4"), (1, 1)), Ok(12));
    assert_eq!(simulate(39, &steps("5 d 10 d 6 d 4 d 2 < 8 > 12"), (1, 1)), Ok(35));
}

#[test]
fn a_back_pass_longer_than_the_round_runs_out() {
    let long = steps("16 < 25 > 9");
    assert_eq!(simulate(26, &long, (1, 1)), Err(Fault::Underflow(42)));
    assert_eq!(simulate(26, &steps("16 < 24 > 9"), (1, 1)), Ok(26));
    assert_eq!(simulate(26, &steps("5 > 9"), (0, 0)), Err(Fault::Turn(5)));
}
