def build(part):
    part.cylinder((0, 0, 0), "+Z", "radius", "thickness", name="Disc")
    part.cylinder((0, 0, -1), "+Z", "screw_radius", "thickness + 2", cut=True, name="ScrewHole")
    part.cylinder((0, 0, 0), "+Z", "counterbore_radius", "counterbore_depth", cut=True, name="Counterbore")
    return part.body, {
        "rod_seat": part.connector("rod_seat", (0, 0, "thickness"), (0, 0, 1), (1, 0, 0)),
    }
