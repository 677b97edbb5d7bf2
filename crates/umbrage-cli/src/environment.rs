//! What drivers expect of the process's environment.

/// Starts the command again, in its place, with an `XDG_RUNTIME_DIR` if it has none.
///
/// Mesa's Vulkan drivers look for a Wayland display when they are loaded. On a machine without a
/// desktop the library that they ask prints "error: XDG_RUNTIME_DIR is invalid or not set in the
/// environment", twice, which reads as a failure of a run that is none. A folder that is not there
/// says that there is no display, and says it quietly. A process's own environment can be changed
/// safely only before it begins, hence the new beginning: the same process, arguments and streams.
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

/// Other systems' drivers do not ask.
#[cfg(not(target_os = "linux"))]
pub fn restart_with_runtime_folder() {}
