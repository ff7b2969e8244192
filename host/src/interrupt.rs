//! The signals by which a user, a terminal that closes or a service manager asks the program to stop.
//!
//! The first asks the work to stop with its best result so far, the second ends the program. A process has one set of handlers: in one
//! that has them already (a test harness) the work cannot be interrupted.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Exit code after a second signal.
const ENDED: i32 = 130;

/// Lets Ctrl-C, and on Unix a request to terminate and a closed terminal, set `stop`.
pub fn sets(stop: &Arc<AtomicBool>) {
    #[cfg(unix)]
    unix::sets(stop);
    #[cfg(not(unix))]
    {
        use std::sync::atomic::Ordering;
        let flag = Arc::clone(stop);
        let _ = ctrlc::set_handler(move || {
            if flag.swap(true, Ordering::Relaxed) {
                std::process::exit(ENDED);
            }
        });
    }
}

#[cfg(unix)]
mod unix {
    use super::ENDED;
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;
    use std::fs;
    use std::os::raw::c_int;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::thread;
    use std::time::{Duration, Instant};

    /// Signals closer together than this are one wish: `timeout` sends each to the program and to its group.
    const ONE_WISH: Duration = Duration::from_millis(300);

    static TAKEN: AtomicBool = AtomicBool::new(false);

    pub(super) fn sets(stop: &Arc<AtomicBool>) {
        if TAKEN.swap(true, Ordering::Relaxed) {
            return;
        }
        let ignored = ignored();
        // Under `nohup` a closed terminal is nobody's wish to stop.
        let taken = [SIGINT, SIGTERM, SIGHUP]
            .into_iter()
            .filter(|signal| ignored >> (signal - 1) & 1 == 0);
        let Ok(mut signals) = Signals::new(taken) else {
            return;
        };
        let stop = Arc::clone(stop);
        thread::spawn(move || {
            let mut first: Option<Instant> = None;
            for _ in &mut signals {
                stop.store(true, Ordering::Relaxed);
                let since = first.get_or_insert_with(Instant::now).elapsed();
                if since > ONE_WISH {
                    std::process::exit(ENDED);
                }
            }
        });
    }

    /// The signals that whoever started the program has set to be ignored, one a bit. Where there is no `/proc`, nobody can say without
    /// changing it: there a closed terminal is left as it is.
    fn ignored() -> u64 {
        let known = fs::read_to_string("/proc/self/status")
            .ok()
            .and_then(|status| {
                let line = status
                    .lines()
                    .find_map(|line| line.strip_prefix("SigIgn:"))?;
                u64::from_str_radix(line.trim(), 16).ok()
            });
        known.unwrap_or(1 << (SIGHUP as c_int - 1))
    }
}
