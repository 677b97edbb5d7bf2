//! The example of the planner alone runs, and reports what it says.

#[path = "../examples/plan_report.rs"]
mod plan_report;

#[test]
fn the_report_names_every_split() {
    let text = plan_report::report().expect("a report");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 1 + 3 + 3, "{text}");
    let texel = |line: &str| -> f64 {
        let words: Vec<&str> = line.split_whitespace().collect();
        let at = words.iter().position(|word| *word == "cm").expect("a texel");
        words[at - 1].parse().expect("a number")
    };
    for (index, line) in lines[1..4].iter().enumerate() {
        assert!(line.trim_start().starts_with(&index.to_string()) && line.contains("of 40"), "{line}");
    }
    // Farther splits have coarser texels.
    assert!(texel(lines[1]) < texel(lines[2]) && texel(lines[2]) < texel(lines[3]), "{text}");
}
