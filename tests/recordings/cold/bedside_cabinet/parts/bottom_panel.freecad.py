def build(part):
    part.box((0, 0, 0), ("length", "depth", "board"), name="Panel")
    part.cylinder(("pin_x", "pin_y", -1), "+Z", "bore_radius", "board + 2", cut=True, name="PinBore")
    return part.body, {
        "left": part.connector("left", (0, 0, 0), (1, 0, 0), (0, 1, 0)),
        "right": part.connector("right", ("length", 0, 0), (-1, 0, 0), (0, 1, 0)),
        "pin": part.connector("pin", ("pin_x", "pin_y", 0), (0, 0, 1), (1, 0, 0)),
    }
