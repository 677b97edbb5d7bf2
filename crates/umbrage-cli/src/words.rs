//! Options whose values are words of a library's list.

use std::str::FromStr;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use umbrage::config::Word;

/// Reads one of some words, which the help lists with what they mean.
pub fn parser<T>(words: &'static [Word]) -> impl TypedValueParser<Value = T>
where
    T: FromStr<Err = String> + Clone + Send + Sync + 'static,
{
    offered(words).try_map(|word| word.parse::<T>())
}

/// Reads one of some words as text.
pub fn offered<'a>(words: impl IntoIterator<Item = &'a Word>) -> PossibleValuesParser {
    PossibleValuesParser::new(words.into_iter().map(|word| PossibleValue::new(word.word).help(word.help.trim())))
}
