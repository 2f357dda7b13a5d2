//! Increases that stand on increases of the round below: how many there are, and how many of them found no other place.

use super::{Graph, NodeId, Stitch, Tile};

/// Increases of some graphs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Increases {
    /// All of them.
    pub all: usize,
    /// Those within one stitch of an increase of the row below.
    pub stacked: usize,
    /// Those of them that are so wherever the increases of their row are put: it has more than bases that are clear.
    pub forced: usize,
}

impl Increases {
    pub(crate) fn of(graphs: &[Graph]) -> Self {
        let mut sum = Self::default();
        for graph in graphs {
            sum.add(&graph.tiles, graph.start, graph.nodes.len());
        }
        sum
    }

    /// Share of those that stand on others without need among those that could stand clear.
    pub(crate) fn by_choice(self) -> f64 {
        let share = |part: usize, whole: usize| if whole > 0 { part as f64 / whole as f64 } else { 0.0 };
        share(self.stacked - self.forced, self.all - self.forced)
    }

    /// Adds those of a graph of so many nodes, of which the first row has `start`.
    pub(crate) fn add(&mut self, tiles: &[Tile], start: NodeId, nodes: usize) {
        let mut made_by_increase = vec![false; nodes];
        for id in tiles.iter().filter(|tile| is_increase(tile)).flat_map(|tile| tile.top.iter()) {
            if let Some(made) = made_by_increase.get_mut(*id as usize) {
                *made = true;
            }
        }
        // The loop after the last of a row is the first of the next, which is not below it.
        let made = |id: NodeId, first: NodeId| id < first && made_by_increase.get(id as usize) == Some(&true);
        let near = |id: NodeId, first: NodeId| {
            (id.saturating_sub(1)..=id.saturating_add(1)).any(|id| made(id, first))
        };
        let mut row = Row::default();
        // A row ends with a turn, and where it comes to its own loops.
        let mut first = start;
        for tile in tiles {
            if tile.stitch.is_none() || tile.base.iter().any(|id| *id >= first) {
                self.add_row(row);
                row = Row::default();
                first = tile.top.first().copied().unwrap_or(first);
            }
            if tile.stitch.is_none() {
                continue;
            }
            row.clear += tile.base.iter().filter(|id| !near(**id, first)).count();
            if is_increase(tile) {
                row.increases += 1;
                row.stacked += usize::from(tile.base.iter().any(|id| near(*id, first)));
            }
        }
        self.add_row(row);
    }

    fn add_row(&mut self, row: Row) {
        self.all += row.increases;
        self.stacked += row.stacked;
        self.forced += row.increases.saturating_sub(row.clear).min(row.stacked);
    }
}

/// The increases of a row, and the bases that have none beside them in the row below.
#[derive(Clone, Copy, Default)]
struct Row {
    increases: usize,
    stacked: usize,
    clear: usize,
}

fn is_increase(tile: &Tile) -> bool {
    tile.stitch.is_some_and(Stitch::is_increase)
}
