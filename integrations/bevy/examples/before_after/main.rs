//! One scene in Bevy without and with planned cascades: as pictures, as wrong pixels against rays,
//! and as the cost of a frame. It needs a graphics adapter and no window.
//!
//! ```text
//! cargo run --example before_after -- pictures FOLDER [NAME]   all pictures, or those of that name
//! cargo run --example before_after -- scores FOLDER [NAME]     wrong pixels, and where they are
//! cargo run --example before_after -- cost [ROBOTS [FRAMES]]   time and casters of a frame
//! cargo run --example before_after -- short                    one view, with a check
//! ```

mod cost;
mod judge;
mod mask;
mod pictures;
mod scores;
mod short;
mod studio;
mod worlds;

use std::path::Path;
use std::process::ExitCode;

/// Whatever went wrong.
pub type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Writes a line of the result.
pub fn say(line: impl std::fmt::Display) {
    #![expect(clippy::print_stdout, reason = "the result is what the program is for")]
    println!("{line}");
}

fn main() -> Result<ExitCode, Failure> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let number = |word: &str| word.parse::<u32>().map_err(|_| format!("`{word}` is no number"));
    match words[..] {
        ["pictures", folder] => pictures::draw(Path::new(folder), "")?,
        ["pictures", folder, wanted] => pictures::draw(Path::new(folder), wanted)?,
        ["scores", folder] => scores::print(Path::new(folder), "")?,
        ["scores", folder, wanted] => scores::print(Path::new(folder), wanted)?,
        ["cost"] => cost::print(160, 24)?,
        ["cost", robots] => cost::print(number(robots)?, 24)?,
        ["cost", robots, frames] => cost::print(number(robots)?, number(frames)? as usize)?,
        ["short"] => return short::check(),
        _ => {
            return Err(
                "say `pictures FOLDER [NAME]`, `scores FOLDER [NAME]`, `cost [ROBOTS [FRAMES]]` or `short`".into()
            );
        }
    }
    Ok(ExitCode::SUCCESS)
}
