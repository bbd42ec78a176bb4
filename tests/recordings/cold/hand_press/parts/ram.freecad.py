def build(part):
    part.box(("-size / 2", "-size / 2", "-length"), ("size", "size", "length + top"), name="Bar")
    part.box(("-slot_width / 2", "-size / 2 - 1", "-slot_depth"), ("slot_width", "size + 2", "slot_depth + top + 1"), cut=True, name="ForkSlot")
    part.cylinder(("-size / 2", 0, 0), "+X", "pin_radius", "size", name="Pin")
    return part.body, {
        "pin": part.connector("pin", (0, 0, 0), (1, 0, 0), (0, 0, 1)),
        "guide": part.connector("guide", (0, 0, "-guide_drop"), (0, 0, -1), (1, 0, 0)),
    }
