def build(part):
    part.box(("-axis_x", "-axis_y", 0), ("width", "board", "height"), name="Panel")
    part.cylinder((0, 0, 0), "+Z", "bore_radius", "bore_depth", cut=True, name="LowerBore")
    part.cylinder((0, 0, "height"), "-Z", "bore_radius", "bore_depth", cut=True, name="UpperBore")
    part.cylinder(("knob_x", "-axis_y", "knob_z"), "+Y", "knob_bore_radius", "knob_bore_depth", cut=True, name="KnobBore")
    return part.body, {
        "hinge": part.connector("hinge", (0, 0, 0), (0, 0, -1), (1, 0, 0)),
        "knob": part.connector("knob", ("knob_x", "-axis_y", "knob_z"), (0, -1, 0), (1, 0, 0)),
    }
