def build(part):
    part.box(("-inset", "-inset", 0), ("width", "thickness", "height"), name="Panel")
    part.cylinder((0, 0, 0), "+Z", "bore_radius", "bore_depth", cut=True, name="LowerBore")
    part.cylinder((0, 0, "height"), "-Z", "bore_radius", "bore_depth", cut=True, name="UpperBore")
    return part.body, {
        "hinge": part.connector("hinge", (0, 0, "-hinge_play / 2"), (0, 0, 1), (1, 0, 0)),
        "handle": part.connector("handle", ("handle_x", "-inset", "handle_z"), (0, -1, 0), (0, 0, 1)),
    }
