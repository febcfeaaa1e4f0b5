//! The memory that is free for a run, as the caller states it.

/// A limit on the memory of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLimit {
    /// The address space of the process (`ulimit -v`).
    Process,
    /// The control group of the process (a container, a service, a job of a cluster).
    ControlGroup,
    /// The memory of the machine.
    Machine,
    /// A number that the user states.
    Stated,
}

/// The memory that a run may take: the free bytes of each known limit. No result depends on it. The library does not query the machine: the caller
/// states what is free.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MemoryLimits {
    /// Limits that are not listed are unknown and not applied.
    pub free_bytes: Vec<(MemoryLimit, u64)>,
}

impl MemoryLimits {
    /// Returns the limit with the fewest free bytes.
    #[must_use]
    pub fn tightest(&self) -> Option<(MemoryLimit, u64)> {
        self.free_bytes.iter().copied().min_by_key(|(_, bytes)| *bytes)
    }
}

impl MemoryLimit {
    pub(crate) fn words(self) -> &'static str {
        match self {
            Self::Process => "within the address space of the process (ulimit -v)",
            Self::ControlGroup => "within the memory of its control group",
            Self::Machine => "on this machine",
            Self::Stated => "by `memory_mb`",
        }
    }
}
