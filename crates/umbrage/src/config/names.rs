//! Words for the values of plain enums: one list has the Rust name, the word and one line of help.

/// Declares an enum without data and a word for each of its values, for config files and the
/// command line.
///
/// The enum gets `ALL`, `WORDS` (word and help, in order), `word()`, `Display` and `FromStr`.
macro_rules! named {
    (
        $(#[$meta:meta])*
        pub enum $name:ident as $what:literal {
            $( $(#[doc = $help:literal])+ $(#[$attribute:ident])? $value:ident = $word:literal, )+
        }
    ) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
        pub enum $name {
            $( $(#[doc = $help])+ $(#[$attribute])? $value, )+
        }

        impl $name {
            /// All values, in the order of their declaration.
            pub const ALL: &'static [Self] = &[$(Self::$value),+];
            /// Word and help of each value.
            pub const WORDS: &'static [$crate::config::Word] =
                &[$($crate::config::Word { word: $word, help: concat!($($help),+) }),+];

            /// The value's word in config files and on the command line.
            #[must_use]
            pub const fn word(self) -> &'static str {
                match self { $(Self::$value => $word),+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.word())
            }
        }

        impl std::str::FromStr for $name {
            type Err = String;

            fn from_str(text: &str) -> Result<Self, String> {
                match text {
                    $($word => Ok(Self::$value),)+
                    _ => Err($crate::config::unknown($what, text, Self::WORDS)),
                }
            }
        }
    };
}
pub(crate) use named;

/// A word that a setting takes as its value, and its meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Word {
    /// The word in config files and on the command line.
    pub word: &'static str,
    /// One line of explanation.
    pub help: &'static str,
}

/// The message for an unknown word.
pub(crate) fn unknown(what: &str, text: &str, words: &[Word]) -> String {
    let words: Vec<&str> = words.iter().map(|word| word.word).collect();
    format!("{text:?} is not a known {what}; give one of {}", words.join(", "))
}
