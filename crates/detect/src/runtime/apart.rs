use std::any::Any;
use std::thread;

/// Runs `work` on a thread of its own and waits for it; what it panicked with, if it did.
///
/// For two reasons. Foreign code that panics on a malformed model must not take the caller with it. And a
/// caller that waits for another thread pool from inside its own would begin its next tile meanwhile, one
/// within the other, and run more of them than there are cores; a caller that waits for a plain thread does
/// nothing else. Starting one takes some tens of microseconds, a run some tens of milliseconds.
pub(super) fn apart<R: Send>(work: impl FnOnce() -> R + Send) -> Result<R, String> {
    thread::scope(|scope| {
        thread::Builder::new()
            .name("network".to_owned())
            .spawn_scoped(scope, work)
            .map_err(|error| format!("no thread could be started: {error}"))?
            .join()
            .map_err(|panic| last_words(panic.as_ref()))
    })
}

/// What a panic said.
pub(super) fn last_words(panic: &(dyn Any + Send)) -> String {
    let text = panic
        .downcast_ref::<String>()
        .map(String::as_str)
        .or_else(|| panic.downcast_ref::<&str>().copied());
    format!("gave up: {}", text.unwrap_or("for an unknown reason"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_message() {
        assert_eq!(apart(|| 7), Ok(7));
        let outcome = apart(|| assert_eq!(1, 2, "one is not two"));
        assert!(outcome.unwrap_err().contains("one is not two"));
    }
}
