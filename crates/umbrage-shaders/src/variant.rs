//! Makes a text of the parts that are used: keeps or drops the code behind `@if(…)` (WESL's
//! conditional translation), at run time.
//!
//! `umbrage-shaders-join` resolves the conditions that are known when the texts are joined, and
//! keeps the conditions of a receiver's choices in them. Such a condition may be followed by a
//! declaration, a member of a struct, a statement or a block.

/// `text` with every `@if(condition)` resolved: `is_on` gives the value of a name.
pub(crate) fn resolved(text: &str, is_on: impl Fn(&str) -> bool) -> String {
    const MARK: &str = "@if";
    let mut result = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(MARK) {
        result.push_str(&rest[..at]);
        let (condition, behind) = parenthesised(&rest[at + MARK.len()..]);
        let behind = behind.trim_start();
        rest = if holds(condition, &is_on) { behind } else { &behind[length(behind)..] };
    }
    result + rest
}

/// The text between the parenthesis that `text` begins with and its partner, and the text after
/// that.
fn parenthesised(text: &str) -> (&str, &str) {
    let text = text.trim_start();
    let mut depth = 0usize;
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth <= 1 => return (&text[1..at], &text[at + 1..]),
            ')' => depth -= 1,
            _ => {}
        }
    }
    (text, "")
}

/// Number of bytes of the declaration, member, statement or block that `text` begins with.
fn length(text: &str) -> usize {
    let (mut round, mut curly) = (0i32, 0i32);
    for (at, c) in text.char_indices() {
        match c {
            '(' | '[' => round += 1,
            ')' | ']' => round -= 1,
            '{' => curly += 1,
            '}' => {
                curly -= 1;
                if curly < 0 {
                    // The last member of a struct, which ends where the struct does.
                    return at;
                }
                let next = text[at + 1..].trim_start();
                if curly == 0 && !next.starts_with("else") {
                    return at + 1;
                }
            }
            ';' | ',' if round == 0 && curly == 0 => return at + 1,
            _ => {}
        }
    }
    text.len()
}

/// The value of a condition: names, `!`, `&&`, `||` and parentheses.
fn holds(condition: &str, is_on: &impl Fn(&str) -> bool) -> bool {
    let mut rest = condition;
    any(&mut rest, is_on)
}

fn any(rest: &mut &str, is_on: &impl Fn(&str) -> bool) -> bool {
    let mut value = all(rest, is_on);
    while skipped(rest, "||") {
        value |= all(rest, is_on);
    }
    value
}

fn all(rest: &mut &str, is_on: &impl Fn(&str) -> bool) -> bool {
    let mut value = one(rest, is_on);
    while skipped(rest, "&&") {
        value &= one(rest, is_on);
    }
    value
}

fn one(rest: &mut &str, is_on: &impl Fn(&str) -> bool) -> bool {
    if skipped(rest, "!") {
        return !one(rest, is_on);
    }
    if skipped(rest, "(") {
        let value = any(rest, is_on);
        skipped(rest, ")");
        return value;
    }
    let text = rest.trim_start();
    let end = text.find(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).unwrap_or(text.len());
    *rest = &text[end..];
    is_on(&text[..end])
}

fn skipped(rest: &mut &str, word: &str) -> bool {
    match rest.trim_start().strip_prefix(word) {
        Some(behind) => {
            *rest = behind;
            true
        }
        None => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(text: &str, on: &[&str]) -> String {
        resolved(text, |name| on.contains(&name)).split_whitespace().collect::<Vec<_>>().join(" ")
    }

    #[test]
    fn conditions_are_evaluated() {
        let holds = |condition: &str, on: &[&str]| holds(condition, &|name: &str| on.contains(&name));
        assert!(holds("a", &["a"]) && !holds("a", &[]) && !holds("!a", &["a"]));
        assert!(holds("a || b && c", &["a"]) && !holds("(a || b) && c", &["a"]));
        assert!(holds("!(a && b) && (c || d)", &["a", "d"]) && !holds("!(a && b) && (c || d)", &["a", "b", "d"]));
    }

    #[test]
    fn declarations_members_statements_and_blocks_come_and_go() {
        let text = "@if(a) fn f(x: u32, y: u32) -> u32 { if x > y { return x; } else { return y; } }
            @if(!a) const F = 1;
            struct S { one: f32, @if(b) two: vec3f, @if(b && a) three: f32 }
            fn g() { @if(b) let x = min(1, 2); @if(!b) { let y = 2; } @if(a) if c { d(); } else if e { h(); } i(); }";
        assert_eq!(
            with(text, &["a"]),
            "fn f(x: u32, y: u32) -> u32 { if x > y { return x; } else { return y; } } struct S { one: f32, } \
             fn g() { { let y = 2; } if c { d(); } else if e { h(); } i(); }"
        );
        assert_eq!(
            with(text, &["b"]),
            "const F = 1; struct S { one: f32, two: vec3f, } fn g() { let x = min(1, 2); i(); }"
        );
    }

    #[test]
    fn what_is_dropped_takes_its_own_conditions_along() {
        assert_eq!(with("@if(a) { @if(b) x(); y(); } @if(b) z();", &["b"]), "z();");
        assert_eq!(with("@if(a) { @if(b) x(); y(); } @if(b) z();", &["a"]), "{ y(); }");
    }
}
