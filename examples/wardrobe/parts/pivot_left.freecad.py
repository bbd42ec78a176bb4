def build(part):
    part.cylinder((0, 0, 0), "+Z", "flange_radius", "flange_thickness", name="Flange")
    part.cylinder((0, 0, "-seat_length"), "+Z", "pin_radius", "seat_length + flange_thickness + pin_length", name="Pin")
    return part.body, {
        "seat": part.connector("seat", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "pin": part.connector("pin", (0, 0, "flange_thickness + hinge_play / 2"), (0, 0, 1), (1, 0, 0)),
    }
