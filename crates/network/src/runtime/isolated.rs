use std::any::Any;

/// Runs `work` on a thread of its own and waits for it; the message of its panic, if it panicked.
///
/// For two reasons. A backend that panics on a malformed model must not take the caller down. And a caller
/// that waits for another thread pool from inside its own would start its next tile meanwhile, nested in the
/// first, and run more tiles than there are cores; a caller that waits for a plain thread does nothing else.
/// Starting a thread takes some tens of microseconds, a run some tens of milliseconds.
#[cfg(feature = "embedded")]
pub(super) fn run_isolated<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, String> {
    std::thread::scope(|scope| {
        std::thread::Builder::new()
            .name("network".to_owned())
            .spawn_scoped(scope, work)
            .map_err(|error| format!("no thread could be started: {error}"))?
            .join()
            .map_err(|panic| panic_message(panic.as_ref()))
    })
}

/// The message of a panic.
pub(super) fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied());
    format!("panicked: {}", text.unwrap_or("for an unknown reason"))
}

#[cfg(all(test, feature = "embedded"))]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_message() {
        assert_eq!(run_isolated(|| 7), Ok(7));
        let failed = run_isolated(|| assert_eq!(1, 2, "one is not two"));
        assert!(failed.unwrap_err().contains("one is not two"));
    }
}
