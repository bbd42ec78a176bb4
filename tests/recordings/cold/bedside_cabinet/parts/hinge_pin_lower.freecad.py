def build(part):
    part.cylinder((0, 0, 0), "+Z", "radius", "length", name="Pin")
    return part.body, {
        "seat": part.connector("seat", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "hinge": part.connector("hinge", (0, 0, "hinge_z"), (0, 0, -1), (1, 0, 0)),
    }
