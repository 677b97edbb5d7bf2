//! Notes for the user at the terminal: parts that were left out, reinterpreted, or invented.

use std::{
    collections::BTreeSet,
    io::Write as _,
    sync::{Mutex, PoisonError},
};

/// Writes each note to standard error in one line, once however often it is repeated.
pub fn say<'n>(notes: impl IntoIterator<Item = &'n String>) {
    static SAID: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let mut said = SAID.lock().unwrap_or_else(PoisonError::into_inner);
    for note in notes {
        if said.insert(note.clone()) {
            // A reader who has left misses it.
            drop(writeln!(std::io::stderr(), "{}", line(note)));
        }
    }
}

/// Makes a note one safe line. Names in files may hold any characters, even those that move a
/// terminal's cursor.
fn line(note: &str) -> String {
    let printable = |c: char| if c.is_control() { '\u{fffd}' } else { c };
    format!("umbrage: note: {}", note.chars().map(printable).collect::<String>())
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_note_is_one_line_whatever_is_in_it() {
        assert_eq!(
            super::line("nodes[0] (a\nb\u{1b}[2J): left out"),
            "umbrage: note: nodes[0] (a\u{fffd}b\u{fffd}[2J): left out"
        );
    }
}
