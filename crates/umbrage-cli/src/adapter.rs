//! `umbrage adapter`: which graphics adapter would be used.

use umbrage_render::{Gpu, GpuOptions};

use crate::{failure::Result, worlds::print};

/// Prints the adapter's name, or fails if there is none.
pub fn run() -> Result<()> {
    let gpu = Gpu::new(&GpuOptions::default())?;
    print(&format!("{}\n", description(&gpu)))
}

/// For reports: name, interface and driver.
pub fn description(gpu: &Gpu) -> String {
    let info = &gpu.adapter_info;
    let driver = [info.driver.as_str(), info.driver_info.as_str()];
    let driver: Vec<&str> = driver.into_iter().filter(|part| !part.is_empty()).collect();
    if driver.is_empty() {
        format!("{} ({})", info.name, info.backend)
    } else {
        format!("{} ({}, {})", info.name, info.backend, driver.join(" "))
    }
}
