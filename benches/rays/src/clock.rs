//! Processor time, which other programs of the machine do not count in.

use std::sync::OnceLock;
use std::time::Instant;

/// Processor time of this thread, s, from the Linux kernel's accounting; elsewhere the clock's.
pub fn cpu_s() -> f64 {
    // The kernel brings the account up to date when a thread yields, otherwise only at its tick.
    std::thread::yield_now();
    let schedstat = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = schedstat.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    nanoseconds.map_or_else(clock_s, |ns| ns * 1e-9)
}

/// Processor time of all threads of this process, those that have ended included, s, from the Linux kernel's accounting in
/// steps of 10 ms; elsewhere the clock's.
pub fn process_cpu_s() -> f64 {
    /// USER_HZ, which Linux fixes for programs.
    const TICKS_A_SECOND: f64 = 100.0;
    let stat = std::fs::read_to_string("/proc/self/stat").ok();
    // Behind the program's name, in brackets, utime and stime are the 12th and 13th field (man 5 proc_pid_stat).
    let ticks = stat.and_then(|text| {
        let mut fields = text.rsplit_once(')')?.1.split_whitespace().skip(11);
        Some(fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?)
    });
    ticks.map_or_else(clock_s, |ticks| ticks / TICKS_A_SECOND)
}

/// Time of the clock since it was first asked, s.
pub fn clock_s() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// What `work` answers, and the processor time of this thread that it took, s.
pub fn timed<R>(work: impl FnOnce() -> R) -> (R, f64) {
    let start = cpu_s();
    let answer = work();
    (answer, cpu_s() - start)
}
