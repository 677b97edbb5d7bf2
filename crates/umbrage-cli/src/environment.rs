//! Environment variables that graphics drivers expect.

/// Restarts the command in place with an `XDG_RUNTIME_DIR`, if it has none.
///
/// Mesa's Vulkan drivers look for a Wayland display when they are loaded. On a machine without a
/// desktop the library for that prints "error: XDG_RUNTIME_DIR is invalid or not set in the
/// environment", twice, although the run does not fail. If the variable names a missing folder, the
/// library finds no display and prints nothing. A process's own environment can be changed safely
/// only before the process begins, hence the restart with the same process id, arguments and
/// streams.
#[cfg(target_os = "linux")]
pub fn restart_with_runtime_folder() {
    use std::os::unix::process::CommandExt as _;

    const VARIABLE: &str = "XDG_RUNTIME_DIR";
    // Debian's name for a folder that never is.
    const NOWHERE: &str = "/nonexistent";
    if std::env::var_os(VARIABLE).is_some_and(|folder| std::path::Path::new(&folder).is_absolute()) {
        return;
    }
    let Ok(program) = std::env::current_exe() else { return };
    let mut arguments = std::env::args_os();
    let mut command = std::process::Command::new(program);
    if let Some(name) = arguments.next() {
        command.arg0(name);
    }
    // Comes back only if the system refuses; the run is then as good as before, with the driver's
    // line.
    drop(command.args(arguments).env(VARIABLE, NOWHERE).exec());
}

/// Does nothing, because drivers of other systems do not need the variable.
#[cfg(not(target_os = "linux"))]
pub fn restart_with_runtime_folder() {}
