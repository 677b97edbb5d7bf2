//! Runs that are ended from outside: finished frames stay, nothing hidden does.
#![cfg(unix)]

mod common;

use std::{
    fs,
    os::unix::process::ExitStatusExt,
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant},
};

use common::{Folder, names};

/// Far more frames than are drawn before the end comes.
const LONG: &str =
    "truth tiny.glb --size 64x48 --path path.json --frames 100000 -o out/mask.png --report out/mask.json";

/// A folder with a run in it that has written some frames.
fn running(folder: &Folder) -> Child {
    let child = folder.command(LONG).stdout(Stdio::null()).stderr(Stdio::piped()).spawn().expect("it starts");
    let begun = Instant::now();
    while written(&folder.at("out")) < 20 {
        assert!(begun.elapsed() < Duration::from_secs(60), "frames are written: {:?}", names(&folder.at("out")));
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn hidden(folder: &Path) -> Vec<String> {
    names(folder).into_iter().filter(|name| name.starts_with('.')).collect()
}

/// Files in the runs' hidden folders.
fn written(folder: &Path) -> usize {
    hidden(folder).iter().map(|name| fs::read_dir(folder.join(name)).map_or(0, Iterator::count)).sum()
}

fn send(signal: &str, child: &Child) {
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill is there");
    assert!(sent.success());
}

#[test]
fn a_signal_leaves_finished_frames_and_nothing_hidden() {
    for (signal, number) in [("-INT", 2), ("-TERM", 15), ("-HUP", 1)] {
        let folder = Folder::new();
        fs::create_dir(folder.at("out")).expect("a folder");
        let child = running(&folder);
        assert_eq!(hidden(&folder.at("out")).len(), 1, "one folder for the run");
        send(signal, &child);
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(output.status.signal(), Some(number), "it ends as the signal says: {:?}", output.status);
        let message = String::from_utf8_lossy(&output.stderr);
        assert!(message.contains("finished files were kept"), "{message}");
        let names = names(&folder.at("out"));
        assert_eq!(hidden(&folder.at("out")), [""; 0], "{signal}");
        // Every frame from the first on, whole, with its report.
        assert!(names.len() >= 10 && names.len().is_multiple_of(2), "{signal}: {names:?}");
        for frame in 0..names.len() / 2 {
            assert_eq!(folder.mask(&format!("out/mask.{frame:04}.png")).dimensions(), (64, 48));
            folder.json(&format!("out/mask.{frame:04}.json"));
        }
    }
}

#[test]
fn the_next_run_clears_away_what_a_killed_one_left() {
    let folder = Folder::new();
    fs::create_dir(folder.at("out")).expect("a folder");
    let mut killed = running(&folder);
    // Another run in the same place, while the first lives, leaves it alone.
    folder.succeed("truth tiny.glb --size 64x48 -o out/first.png");
    assert!(written(&folder.at("out")) >= 20);
    killed.kill().expect("it is killed");
    killed.wait().expect("it is gone");
    assert_eq!(hidden(&folder.at("out")).len(), 1, "nobody could clean up");
    folder.succeed("truth tiny.glb --size 64x48 -o out/second.png");
    assert_eq!(names(&folder.at("out")), ["first.png", "second.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_run_without_a_desktop_is_quiet() {
    if !common::has_adapter() {
        return;
    }
    let folder = Folder::new();
    for runtime_folder in [None, Some("not/absolute")] {
        let mut command = folder.command("adapter");
        command.env_remove("XDG_RUNTIME_DIR");
        runtime_folder.map(|folder| command.env("XDG_RUNTIME_DIR", folder));
        let output = command.output().expect("it starts");
        assert!(output.status.success());
        assert_eq!(common::stderr(&output), "", "with {runtime_folder:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_vulkan_driver_it_is_said_what_to_install() {
    // Where OpenGL can draw everything the run is as good as any.
    let folder = Folder::new();
    let nowhere = folder.at("no-driver.json");
    let mut command = folder.command("render tiny.glb --size 16x16 --map-size 64 -o out.png");
    let output =
        command.env("VK_DRIVER_FILES", &nowhere).env("VK_ICD_FILENAMES", &nowhere).output().expect("it starts");
    if output.status.success() {
        return;
    }
    let message = common::stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    let told = message.lines().filter(|line| !line.starts_with("umbrage: note: ")).count();
    assert!(message.contains("mesa-vulkan-drivers") && told == 1, "{message}");
    assert!(!message.contains("Validation Error"), "{message}");
    assert_eq!(folder.new_names(), [""; 0]);
}
