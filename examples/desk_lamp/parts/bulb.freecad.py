def build(part):
    part.cylinder((0, 0, 0), "+Z", "holder_radius", "holder_height", name="Holder")
    part.sphere((0, 0, "globe_z"), "globe_radius", name="Globe")
    return part.body, {"foot": part.connector("foot", (0, 0, 0), (0, 0, 1), (0, 1, 0))}
