def build(part):
    part.box((0, "-width / 2", 0), ("thickness", "width", "height"), name="Upright")
    part.box((0, "-neck_width / 2", "-neck_height"), ("foot_length", "neck_width", "neck_height"), name="Neck")
    part.box((0, "-head_width / 2", "-neck_height - head_height"), ("foot_length", "head_width", "head_height"), name="Head")
    part.cylinder(("thickness / 2", "-width / 2 - 1", "height - hole_drop"), "+Y", "hole_radius", "width + 2", cut=True, name="CrossHole")
    return part.body, {
        "seat": part.connector("seat", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "slide": part.connector("slide", (0, 0, 0), (1, 0, 0), (0, 0, 1)),
    }
