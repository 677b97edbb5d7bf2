//! A config as a table of settings, in JSON, TOML or any other format of serde.

use serde::de::{Deserialize, Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde::ser::{Serialize, SerializeMap, Serializer};

use super::{Preset, ShadowConfig, Value};

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Word(word) => word.serialize(serializer),
            Self::Number(number) => number.serialize(serializer),
            Self::Count(count) => count.serialize(serializer),
            Self::Numbers(numbers) => numbers.serialize(serializer),
            Self::Counts(counts) => counts.serialize(serializer),
            Self::Switch(_) => serializer.collect_str(self),
        }
    }
}

impl Serialize for ShadowConfig {
    /// Writes every setting that the config has, under its key.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let settings = self.settings();
        let mut map = serializer.serialize_map(Some(settings.len()))?;
        for (key, value) in settings {
            map.serialize_entry(key, &value)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for ShadowConfig {
    /// Reads settings over the default config, or over the preset that `preset` names.
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(Settings)
    }
}

struct Settings;

impl<'de> Visitor<'de> for Settings {
    type Value = ShadowConfig;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a table of shadow settings")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<ShadowConfig, A::Error> {
        let mut config = ShadowConfig::default();
        let mut given = Vec::new();
        while let Some(key) = map.next_key::<String>()? {
            let Text(value) = map.next_value().map_err(|error| A::Error::custom(format!("{key}: {error}")))?;
            if key == "preset" {
                config = value.parse::<Preset>().map_err(A::Error::custom)?.config();
            } else {
                given.push((key, value));
            }
        }
        config.apply(&given).map_err(A::Error::custom)?;
        Ok(config)
    }
}

/// A word, number, switch or list as the text that a setting reads.
struct Text(String);

impl<'de> Deserialize<'de> for Text {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(TextVisitor).map(Text)
    }
}

struct TextVisitor;

impl<'de> Visitor<'de> for TextVisitor {
    type Value = String;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("a word, a number, a switch or a list of these")
    }

    fn visit_str<E>(self, text: &str) -> Result<String, E> {
        Ok(text.to_owned())
    }

    fn visit_bool<E>(self, on: bool) -> Result<String, E> {
        Ok(on.to_string())
    }

    fn visit_u64<E>(self, number: u64) -> Result<String, E> {
        Ok(number.to_string())
    }

    fn visit_i64<E>(self, number: i64) -> Result<String, E> {
        Ok(number.to_string())
    }

    fn visit_f64<E>(self, number: f64) -> Result<String, E> {
        Ok(number.to_string())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut values: A) -> Result<String, A::Error> {
        let mut list = Vec::new();
        while let Some(Text(value)) = values.next_element()? {
            list.push(value);
        }
        Ok(list.join(","))
    }
}
