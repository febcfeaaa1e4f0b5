//! Duration of work on an otherwise idle machine: measured by CPU time, which excludes other programs.

use crate::Clock;

/// A time interval, by wall-clock and CPU time.
pub(crate) struct WorkTimer<'a> {
    clock: &'a dyn Clock,
    from_s: f64,
    from_processor_s: Option<f64>,
}

impl<'a> WorkTimer<'a> {
    pub(crate) fn start(clock: &'a dyn Clock) -> Self {
        Self { clock, from_s: clock.seconds(), from_processor_s: clock.processor_seconds() }
    }

    /// Wall-clock time, s.
    pub(crate) fn clock_s(&self) -> f64 {
        self.clock.seconds() - self.from_s
    }

    /// CPU time of all threads, s; if the machine does not report it, all threads are assumed to have worked.
    pub(crate) fn processor_s(&self) -> f64 {
        let cpu_s = self.from_processor_s.and_then(|from_s| Some(self.clock.processor_seconds()? - from_s));
        cpu_s.unwrap_or_else(|| self.clock_s() * self.clock.threads() as f64)
    }

    /// Duration, on an idle machine, of work that one thread or partly several threads do: wall-clock time if the machine is idle, CPU time otherwise.
    pub(crate) fn idle_machine_s(&self) -> f64 {
        self.clock_s().min(self.processor_s())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::atomic::{AtomicU32, Ordering};

    /// A machine of two threads that gives this program half of its time.
    struct HalfBusyClock(AtomicU32, bool);

    impl Clock for HalfBusyClock {
        fn seconds(&self) -> f64 {
            f64::from(self.0.load(Ordering::Relaxed))
        }

        fn processor_seconds(&self) -> Option<f64> {
            self.1.then(|| 0.5 * self.seconds())
        }

        fn threads(&self) -> usize {
            2
        }
    }

    #[test]
    fn other_programs_do_not_count_where_cpu_time_is_known() {
        let (busy, silent) = (HalfBusyClock(AtomicU32::new(1), true), HalfBusyClock(AtomicU32::new(1), false));
        let [known, unknown] = [&busy, &silent].map(|clock| WorkTimer::start(clock));
        busy.0.store(5, Ordering::Relaxed);
        silent.0.store(5, Ordering::Relaxed);
        assert_eq!([known.clock_s(), known.processor_s(), known.idle_machine_s()], [4.0, 2.0, 2.0]);
        assert_eq!([unknown.clock_s(), unknown.processor_s(), unknown.idle_machine_s()], [4.0, 8.0, 4.0]);
    }
}
