//! Remarks on a file: elements that were left out or read differently.

use std::cell::RefCell;
use std::collections::BTreeMap;

/// Remarks, each with the first element concerned and the number of elements.
#[derive(Default)]
pub(super) struct Notes(RefCell<BTreeMap<String, (String, usize)>>);

impl Notes {
    /// Makes a remark about an element.
    pub(super) fn add(&self, element: impl Into<String>, remark: impl Into<String>) {
        self.0.borrow_mut().entry(remark.into()).or_insert_with(|| (element.into(), 0)).1 += 1;
    }

    /// Returns one line for each remark: the first element, the number of further ones, the remark.
    pub(super) fn into_lines(self) -> Vec<String> {
        let line = |(remark, (element, count)): (String, (String, usize))| match count {
            1 => format!("{element}: {remark}"),
            n => format!("{element} and {} more: {remark}", n - 1),
        };
        self.0.into_inner().into_iter().map(line).collect()
    }
}
