//! Clean-up after an interrupted run: its finished frames stay, and no hidden folder is left.

use std::sync::{Arc, Mutex, PoisonError, Weak};

use super::Pending;

/// Outputs of this process that are not in place yet.
static PENDING: Mutex<Vec<Weak<Mutex<Pending>>>> = Mutex::new(Vec::new());

/// Registers outputs for clean-up on a signal.
pub(super) fn watch(pending: &Arc<Mutex<Pending>>) {
    let mut all = PENDING.lock().unwrap_or_else(PoisonError::into_inner);
    all.retain(|other| other.strong_count() > 0);
    all.push(Arc::downgrade(pending));
}

/// Makes SIGINT (Ctrl-C), SIGTERM and SIGHUP put finished frames in place and remove hidden folders
/// before they end the process. Systems other than Unix end it at once.
pub fn clean_up_on_signals() {
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        // Without a handler signals end the process as ever, and the next run cleans up.
        let Ok(mut signals) = signal_hook::iterator::Signals::new([SIGHUP, SIGINT, SIGTERM]) else { return };
        std::thread::spawn(move || {
            if let Some(signal) = signals.forever().next() {
                interrupted(signal);
            }
        });
    }
}

#[cfg(unix)]
fn interrupted(signal: i32) {
    let all = PENDING.lock().unwrap_or_else(PoisonError::into_inner);
    let live: Vec<_> = all.iter().filter_map(Weak::upgrade).collect();
    // Held until the process ends: nothing more is written.
    let mut held: Vec<_> = live.iter().map(|pending| pending.lock().unwrap_or_else(PoisonError::into_inner)).collect();
    for pending in &mut held {
        let kept = pending.keep_finished();
        if kept > 0 {
            eprintln!("umbrage: interrupted; {kept} finished files were kept");
        }
    }
    drop(signal_hook::low_level::emulate_default_handler(signal));
    // A signal whose default does not end the process, which none of these is.
    std::process::exit(1);
}
