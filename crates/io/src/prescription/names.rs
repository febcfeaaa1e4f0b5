//! Commands of CODE V files that say nothing of a centred lens as it stands, and those that would change it in a way that is not modelled.

/// Commands that change the lens or the light's way in a manner that is not modelled.
pub(super) const REFUSED: &[&str] = &[
    "XDE", "YDE", "ZDE", "ADE", "BDE", "CDE", "DAR", "BEN", "REV", "RET", "GRT", "DIF", "HOE", "SPS", "XTO", "YTO",
    "CYL", "AAS", "ZOO", "NSS", "REFL", "GRX", "DOE", "REX", "REY", "ELX", "ELY", "ADX", "ADY", "ARO", "RDX", "CUX",
    "KX", "RMD", "INS", "DEL", "COP", "FLI", "UDS", "XYP", "ZRN", "ZFR", "SPL", "TOR", "GRN",
];

/// Commands that leave the lens as it stands: weights and variables of optimisation, labels, the form of surfaces that their terms tell, and the end
/// of input.
pub(super) const PASSED_OVER: &[&str] = &[
    "GO", "LEN", "INI", "SLB", "DDM", "UID", "CCY", "CCX", "THC", "GLC", "KC", "AC", "BC", "CC", "DC", "EC", "FC",
    "GC", "HC", "JC", "ASP", "SPH", "CON", "WTW", "WTF", "WTX", "WTY", "VUX", "VLX", "HIN", "EVA", "CA", "END",
];
