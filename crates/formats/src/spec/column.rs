//! An array of `cell_data`, checked against the blocks of cells.

use super::block::Block;
use crate::check::Check;
use crate::text::fault::Fault;
use crate::text::place::Place;

/// One array of `cell_data`: for each block of cells, one item per cell or one for the whole block.
pub(super) struct Column<'r, T> {
    key: &'static str,
    /// Whether the file contains the array.
    pub given: bool,
    blocks: Option<&'r Vec<Block<T>>>,
}

impl<'r, T: PartialEq> Column<'r, T> {
    /// Checks the lengths against `counts`, the number of cells of each block. Wrong lengths are faults, and the
    /// column is then empty.
    pub fn new(
        key: &'static str,
        blocks: &'r Option<Vec<Block<T>>>,
        counts: &[usize],
        at: &Place<'_>,
        check: &mut Check<'_>,
    ) -> Self {
        let Some(given) = blocks else {
            return Column {
                key,
                given: false,
                blocks: None,
            };
        };
        let before = check.faults.0.len();
        let place = at.key(key);
        let hint = "cell_data has one array for each block of `cells`, with one item for each cell, or one item for the block";
        if given.len() != counts.len() {
            let fault =
                Fault::new(&place, format!("must have {} arrays", counts.len())).got(given.len());
            check.faults.add(fault.hint(hint));
        }
        for (block, (items, count)) in given.iter().zip(counts).enumerate() {
            let Block::Each(items) = items else { continue };
            if items.len() != *count {
                let fault = Fault::new(&place.index(block), format!("must have {count} items"))
                    .got(items.len());
                check.faults.add(fault.hint(hint));
            }
        }
        Column {
            key,
            given: true,
            blocks: (check.faults.0.len() == before).then_some(given),
        }
    }

    /// The item of a cell.
    pub fn get(&self, block: usize, index: usize) -> Option<&'r T> {
        self.blocks
            .and_then(|blocks| blocks.get(block))
            .and_then(|items| items.get(index))
    }

    /// Whether the column has no item for this block.
    pub fn absent(&self, block: usize) -> bool {
        self.blocks
            .and_then(|blocks| blocks.get(block))
            .is_some_and(|items| *items == Block::Absent)
    }

    /// Calls `then` with the place of the item of a cell below `data`, the place of `cell_data`. If one item applies
    /// to the whole block, the place is that of the block.
    pub fn at<R>(
        &self,
        [block, index]: [usize; 2],
        data: &Place<'_>,
        then: impl FnOnce(&Place<'_>) -> R,
    ) -> R {
        let key = data.key(self.key);
        let place = key.index(block);
        match self.blocks.and_then(|blocks| blocks.get(block)) {
            Some(Block::Each(_)) => then(&place.index(index)),
            _ => then(&place),
        }
    }
}
