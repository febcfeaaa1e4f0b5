"""Tables of a comparison, in Markdown."""

NAMES = {"etendue": "Étendue", "etendue-guided": "Étendue, guided", "etendue-branched": "Étendue, branched",
         "etendue-guided-branched": "Étendue, guided, branched", "etendue-reuse": "Étendue, path reuse",
         "etendue-guided-reuse": "Étendue, guided, path reuse", "mitsuba": "Mitsuba", "cycles": "Cycles"}


def table(head, rows):
    lines = [head, ["---"] * 2 + ["---:"] * (len(head) - 2), *rows]
    return "\n".join("| " + " | ".join(cells) + " |" for cells in lines)


def errors(found):
    """What every renderer took, and how far its pictures are from its mean."""
    rows = []
    for scene, of in found["scenes"].items():
        for renderer, row in of["renderers"].items():
            road = "" if row["road_rms"] is None else f"{100 * row['road_rms']:.1f} %"
            rows.append([scene, NAMES[renderer], f"{row['cpu_s']:.2f}", f"{row['us_a_path']:.2f}",
                         f"{row['relative_mse']:.4f}", f"{row['box_mse']:.2e}", road, f"{row['efficiency']:.3f}",
                         f"{row['box_efficiency']:.1f}"])
    return table(["scene", "renderer", "CPU s", "µs a path", "relative MSE", "of box means", "road, rms", "efficiency",
                  "of box means"], rows)


def ratios(found):
    """Étendue over its peers."""
    rows = []
    for scene, of in found["scenes"].items():
        for renderer, row in of["renderers"].items():
            for ours, over in row.get("beside", {}).items():
                rows.append([f"{scene}: {NAMES[ours]}", NAMES[renderer], f"{over['us_a_path']:.2f}",
                             f"{over['efficiency']:.2f}", f"{over['box_efficiency']:.2f}", *apart(row, ours)])
    return table(["scene, ours", "over", "time of a path", "efficiency", "of box means", "its mean over ours",
                  "farthest region"], rows)


def apart(row, ours):
    """How far the peer's means are from ours, told once."""
    if ours != "etendue":
        return ["", ""]
    found = row["agreement"]
    return [f"{found['mean_ratio']:.4f}", f"{found['farthest_region']:.3f} ± {found['its_standard_error']:.3f}"]


def text(found):
    """Everything, with what it was measured on."""
    options = found["options"]
    kernels = "; ".join(f"{NAMES[name]}: {what}" for name, what in found["instructions"].items() if name in NAMES)
    return (f"{found['processor']}. Kernels: {kernels}.\n"
            f"{options['spp']} samples a pixel, {options['runs']} pictures of each, {options['threads']} threads; load of the "
            f"machine before and after: {found['load_before']:.1f}, {found['load_after']:.1f}.\n\n"
            f"{errors(found)}\n\n{ratios(found)}")
