//! Remarks on a file: what was left out, or taken for something else than it says.

use std::cell::RefCell;
use std::collections::BTreeMap;

/// Remarks, each with the first element that it is about and how many there are.
#[derive(Default)]
pub(super) struct Notes(RefCell<BTreeMap<String, (String, usize)>>);

impl Notes {
    /// Makes a remark about an element.
    pub(super) fn add(&self, element: impl Into<String>, remark: impl Into<String>) {
        self.0.borrow_mut().entry(remark.into()).or_insert_with(|| (element.into(), 0)).1 += 1;
    }

    /// One line each: the element at fault, how many more there are, the remark.
    pub(super) fn into_lines(self) -> Vec<String> {
        let line = |(remark, (element, count)): (String, (String, usize))| match count {
            1 => format!("{element}: {remark}"),
            n => format!("{element} and {} more: {remark}", n - 1),
        };
        self.0.into_inner().into_iter().map(line).collect()
    }
}
