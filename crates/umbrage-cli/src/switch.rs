//! Options that are `on` or `off`.

/// A switch on the command line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Switch {
    /// Enabled
    #[default]
    On,
    /// Disabled
    Off,
}
