//! Handler of Ctrl-C. The first one stops the study that runs, so that its finished part is kept. Without a study, and
//! the second time, the command ends at once.

use crate::error::INTERRUPTED;
use crate::terminal::print_error;
use pxpl5::StopFlag;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, Ordering};

static STOP: LazyLock<StopFlag> = LazyLock::new(StopFlag::default);
/// True while work runs that looks at the flag.
static IS_FOLLOWED: AtomicBool = AtomicBool::new(false);

/// Installs the handler for this process. A process has one handler, so later calls have no effect.
pub(crate) fn listen() {
    let _ = ctrlc::set_handler(|| {
        if STOP.is_stopped() || !IS_FOLLOWED.load(Ordering::Relaxed) {
            print_error("\npxpl5: interrupted; nothing was written\n");
            std::process::exit(INTERRUPTED.into());
        }
        STOP.stop();
    });
}

/// Returns the flag that Ctrl-C sets.
pub(crate) fn flag() -> StopFlag {
    STOP.clone()
}

/// Tells the handler whether work runs that looks at the flag.
pub(crate) fn follow(is_followed: bool) {
    IS_FOLLOWED.store(is_followed, Ordering::Relaxed);
}
