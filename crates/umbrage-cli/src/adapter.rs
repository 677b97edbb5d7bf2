//! `umbrage adapter`: prints the graphics adapter that would be used.

use umbrage_lab::failure::Result;
use umbrage_render::{Gpu, GpuOptions};

use crate::print::print;

/// Prints the adapter's name, or fails if there is none.
pub fn run() -> Result<()> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    print(&format!("{}\n", gpu.description()))
}
