//! The memory that is free for a run, as Linux states it. A limit that cannot be read is not applied.

use etendue::{MemoryLimit, MemoryLimits};
use std::path::{Path, PathBuf};

/// Limits of control groups from this value on mean "no limit": version 1 states the largest number of pages.
const NO_LIMIT_BYTES: u64 = 1 << 60;

/// Returns the memory that is free at this moment.
#[must_use]
pub fn free() -> MemoryLimits {
    free_by(&|path| std::fs::read_to_string(path).ok())
}

/// Returns the limits of a run: the number of MB that the user states, 0 for none, or what is free.
#[must_use]
pub fn stated_or_free(stated_mb: Option<u32>) -> MemoryLimits {
    match stated_mb {
        None => free(),
        Some(0) => MemoryLimits::default(),
        Some(mb) => MemoryLimits { free_bytes: vec![(MemoryLimit::Stated, u64::from(mb) * 1_000_000)] },
    }
}

/// As [`free`], with the files that `read` returns.
fn free_by(read: &dyn Fn(&Path) -> Option<String>) -> MemoryLimits {
    let process = || {
        let limit = address_space(&read(Path::new("/proc/self/limits"))?)?;
        Some(limit.saturating_sub(kib_of(&read(Path::new("/proc/self/status"))?, "VmSize:")?))
    };
    let group = || read(Path::new("/proc/self/cgroup")).and_then(|groups| free_in_groups(&groups, read));
    let machine = || kib_of(&read(Path::new("/proc/meminfo"))?, "MemAvailable:");
    let limits =
        [(MemoryLimit::Process, process()), (MemoryLimit::ControlGroup, group()), (MemoryLimit::Machine, machine())];
    MemoryLimits { free_bytes: limits.into_iter().filter_map(|(limit, free)| Some((limit, free?))).collect() }
}

/// Returns the soft limit of the address space in /proc/self/limits, bytes; `None` if it is unlimited.
fn address_space(limits: &str) -> Option<u64> {
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Returns the size in a line `NAME: N kB`, bytes.
fn kib_of(text: &str, name: &str) -> Option<u64> {
    let line = text.lines().find_map(|line| line.strip_prefix(name))?;
    line.split_whitespace().next()?.parse::<u64>().ok()?.checked_mul(1024)
}

/// A hierarchy of control groups: its mount point and the names of its files.
struct ControlGroupHierarchy {
    mount: &'static str,
    limit: &'static str,
    used: &'static str,
    /// The lines of `memory.stat` with the pages that the kernel reclaims before it ends a process: those of files, and of its own caches.
    reclaimable: &'static [&'static str],
}

const VERSION_1: ControlGroupHierarchy = ControlGroupHierarchy {
    mount: "/sys/fs/cgroup/memory",
    limit: "memory.limit_in_bytes",
    used: "memory.usage_in_bytes",
    reclaimable: &["total_inactive_file ", "total_active_file "],
};
const VERSION_2: ControlGroupHierarchy = ControlGroupHierarchy {
    mount: "/sys/fs/cgroup",
    limit: "memory.max",
    used: "memory.current",
    reclaimable: &["inactive_file ", "active_file ", "slab_reclaimable "],
};

/// Returns the memory that is free in the groups of /proc/self/cgroup and their parents, bytes; `None` if none has a limit.
fn free_in_groups(groups: &str, read: &dyn Fn(&Path) -> Option<String>) -> Option<u64> {
    let group = |line: &str| {
        let mut parts = line.splitn(3, ':');
        let (_, controllers, path) = (parts.next()?, parts.next()?, parts.next()?);
        match controllers {
            "" => Some((VERSION_2, PathBuf::from(path))),
            names => names.split(',').any(|name| name == "memory").then(|| (VERSION_1, PathBuf::from(path))),
        }
    };
    let free_of_group = |(hierarchy, path): (ControlGroupHierarchy, PathBuf)| {
        let free = |at: &Path| free_in(&hierarchy, at.strip_prefix("/").unwrap_or(at), read);
        path.ancestors().filter_map(free).min()
    };
    groups.lines().filter_map(group).filter_map(free_of_group).min()
}

/// Returns the memory that is free in one group, bytes. In a container the path may be that of the host, which does not exist there.
fn free_in(hierarchy: &ControlGroupHierarchy, group: &Path, read: &dyn Fn(&Path) -> Option<String>) -> Option<u64> {
    let folder = Path::new(hierarchy.mount).join(group);
    let number = |name: &str| read(&folder.join(name))?.trim().parse::<u64>().ok();
    let limit = number(hierarchy.limit).filter(|limit| *limit < NO_LIMIT_BYTES)?;
    let statistics = read(&folder.join("memory.stat")).unwrap_or_default();
    let bytes_of = |name: &&str| statistics.lines().find_map(|line| line.strip_prefix(*name)?.parse::<u64>().ok());
    let reclaimable = hierarchy.reclaimable.iter().filter_map(bytes_of).sum();
    let used = number(hierarchy.used).unwrap_or(0).saturating_sub(reclaimable);
    Some(limit.saturating_sub(used))
}

#[cfg(test)]
mod tests {
    use super::*;
    use MemoryLimit::{ControlGroup, Machine, Process};

    const LIMITS: &str = "Limit                     Soft Limit           Hard Limit           Units     \n\
        Max cpu time              unlimited            unlimited            seconds   \n\
        Max address space         512000000            unlimited            bytes     \n";

    fn free_of(files: &[(&str, &str)]) -> Vec<(MemoryLimit, u64)> {
        let text =
            |path: &Path| files.iter().find(|(name, _)| Path::new(name) == path).map(|(_, text)| (*text).to_owned());
        free_by(&text).free_bytes
    }

    #[test]
    fn limits_that_cannot_be_read_are_not_applied() {
        assert_eq!(free_of(&[]), []);
        let unlimited = LIMITS.replace("512000000", "unlimited");
        let status = ("/proc/self/status", "VmSize:\t  1000 kB\n");
        assert_eq!(free_of(&[("/proc/self/limits", &unlimited), status]), []);
        assert_eq!(free_of(&[("/proc/meminfo", "MemAvailable: much\n"), ("/proc/self/cgroup", "0:/a\nx\n")]), []);
    }

    #[test]
    fn free_address_space_is_the_limit_less_the_size_of_the_process() {
        let status = ("/proc/self/status", "Name:\tetendue\nVmPeak:\t 2000 kB\nVmSize:\t  1000 kB\n");
        let (limits, memory) =
            (("/proc/self/limits", LIMITS), ("/proc/meminfo", "MemFree: 5 kB\nMemAvailable:    7 kB\n"));
        assert_eq!(free_of(&[limits, status, memory]), [(Process, 510_976_000), (Machine, 7168)]);
        let full = ("/proc/self/status", "VmSize:\t  1000000 kB\n");
        assert_eq!(free_of(&[limits, full]), [(Process, 0)]);
    }

    #[test]
    fn the_tightest_group_of_version_2_applies() {
        let files = [
            ("/proc/self/cgroup", "0::/jobs/mine\n"),
            ("/sys/fs/cgroup/jobs/mine/memory.max", "max\n"),
            ("/sys/fs/cgroup/jobs/memory.max", "1000000\n"),
            ("/sys/fs/cgroup/jobs/memory.current", "600000\n"),
            ("/sys/fs/cgroup/jobs/memory.stat", "anon 5\ninactive_file 100000\n"),
            ("/sys/fs/cgroup/memory.max", "900000\n"),
        ];
        assert_eq!(free_of(&files), [(ControlGroup, 500_000)]);
    }

    #[test]
    fn groups_of_version_1_have_limits_and_a_number_for_none() {
        let groups = ("/proc/self/cgroup", "9:name=systemd:/\n4:memory:/pod/a:b\n3:cpu,cpuacct:/x\n0::/\n");
        let own = "/sys/fs/cgroup/memory/pod/a:b";
        let limit = format!("{own}/memory.limit_in_bytes");
        let (used, stat) = (format!("{own}/memory.usage_in_bytes"), format!("{own}/memory.stat"));
        let files =
            |limit_text| [groups, (&limit[..], limit_text), (&used, "300\n"), (&stat, "total_inactive_file 100\n")];
        assert_eq!(free_of(&files("1000\n")), [(ControlGroup, 800)]);
        assert_eq!(free_of(&files("9223372036854771712\n")), []);
        // In a container the group is the root of the mounted hierarchy.
        let mounted = ("/sys/fs/cgroup/memory/memory.limit_in_bytes", "2000\n");
        assert_eq!(free_of(&[groups, mounted]), [(ControlGroup, 2000)]);
    }
}
