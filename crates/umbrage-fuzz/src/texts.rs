//! Techniques by name and config files.

use umbrage_lab::technique::ConfigFile;
use umbrage_lab::technique::text::{finish, parse_all, parse_file};

/// Reads the first line as a list of techniques and the second as settings of all of them; and the
/// whole as a file of techniques.
pub fn techniques(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if let Ok((with, sources)) = parse_file("techniques.toml", text) {
        // Each is a technique or has a fault; what it has is a typed error.
        drop(finish(&sources, &with, None));
    }
    let mut lines = text.lines();
    let list: Vec<String> = lines.next().unwrap_or_default().split(',').map(str::to_owned).collect();
    let Ok(techniques) = parse_all(&list, lines.next().unwrap_or_default()) else { return };
    for technique in techniques {
        technique.shadows.config.validate().expect("a technique is valid");
        let again = parse_all(std::slice::from_ref(&technique.spec), "");
        let again = again.unwrap_or_else(|error| panic!("{} is not read again: {error}", technique.spec));
        assert_eq!(again.len(), 1, "{}", technique.spec);
        assert_eq!(again[0].shadows.config, technique.shadows.config, "{}", technique.spec);
    }
}

/// Reads a config file, and writes its config as JSON and as TOML.
pub fn config(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(file) = ConfigFile::parse(text) else { return };
    file.config.validate().expect("a config that was read is valid");
    let json = serde_json::to_string(&file.config).expect("a config can be written as JSON");
    let toml = toml::to_string(&file.config).expect("a config can be written as TOML");
    for written in [json, toml] {
        let again = ConfigFile::parse(&written).unwrap_or_else(|error| panic!("{written} is not read again: {error}"));
        assert_eq!(again.config, file.config, "{written}");
    }
}
