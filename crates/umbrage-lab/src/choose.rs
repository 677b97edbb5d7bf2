//! Choice of cameras and lights of a scene by name or number.

use crate::failure::{Failure, Result};

/// Returns the index of one element called `wanted`, whatever characters its name has, or those of
/// several between commas; at least one.
///
/// # Errors
/// [`Failure::Input`] with the option, the missing name and the existing ones.
pub fn several(option: &str, kind: &str, wanted: &str, names: &[&str]) -> Result<Vec<usize>> {
    if names.contains(&wanted) || !wanted.contains(',') {
        return Ok(vec![select(option, kind, wanted, names)?]);
    }
    let mut indices = Vec::new();
    for part in wanted.split(',') {
        let index = select(option, kind, part, names)?;
        if indices.contains(&index) {
            return Err(Failure::input(format!("{option} {wanted}: {part} is in the list twice; give it once")));
        }
        indices.push(index);
    }
    Ok(indices)
}

/// Returns the index of the element called `wanted`, or with that number.
///
/// # Errors
/// As [`several`].
pub fn select(option: &str, kind: &str, wanted: &str, names: &[&str]) -> Result<usize> {
    let by_name = names.iter().position(|name| *name == wanted);
    let by_index = || wanted.parse().ok().filter(|index| *index < names.len());
    by_name.or_else(by_index).ok_or_else(|| {
        let there = match names {
            [] => format!("the scene has no {kind}"),
            _ => {
                let list: Vec<String> = names.iter().enumerate().map(|(i, name)| named(name, i)).collect();
                format!("there is no {kind} of that name or number; there are {}", list.join(", "))
            }
        };
        Failure::input(format!("{option} {wanted}: {there}"))
    })
}

/// Returns a name for display, even for elements without one.
#[must_use]
pub fn named(name: &str, index: usize) -> String {
    if name.is_empty() { index.to_string() } else { name.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_go_before_numbers() {
        let names = ["front", "0", ""];
        assert_eq!(select("--camera", "camera", "front", &names), Ok(0));
        assert_eq!(select("--camera", "camera", "0", &names), Ok(1));
        assert_eq!(select("--camera", "camera", "2", &names), Ok(2));
        let error = select("--camera", "camera", "3", &names).expect_err("there is no fourth").to_string();
        assert!(error.contains("--camera 3") && error.contains("front, 0, 2"), "{error}");
        assert!(select("--camera", "camera", "-1", &names).is_err());
        assert!(select("--light", "light", "0", &[]).is_err());
        assert_eq!(several("--camera", "camera", "front,2", &names), Ok(vec![0, 2]));
        assert_eq!(several("--camera", "camera", "a,b", &["b", "a,b"]), Ok(vec![1]), "a name may have a comma");
        let error = several("--camera", "camera", "front,2,front", &names).expect_err("twice").to_string();
        assert!(error.contains("front is in the list twice"), "{error}");
    }
}
