def build(part):
    part.cylinder((0, 0, "-height / 2"), "+Z", "outer_radius", "height", name="Tube")
    part.box((0, "-seat_width / 2", "-seat_height / 2"), ("seat_x", "seat_width", "seat_height"), name="SeatBlock")
    part.box(("seat_x", "-lug_width / 2", "-seat_height / 2"), ("lug_length", "lug_width", "seat_height"), name="Lug")
    part.cylinder((0, 0, "-height / 2 - 1"), "+Z", "bore_radius", "height + 2", cut=True, name="Bore")
    part.cylinder(("seat_x + pin_offset", "-lug_width / 2 - 1", 0), "+Y", "pin_radius", "lug_width + 2", cut=True, name="PinHole")
    return part.body, {
        "bore": part.connector("bore", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "arm_seat": part.connector("arm_seat", ("seat_x", "(lug_width + seat_width) / 4", 0), (1, 0, 0), (0, 0, 1)),
    }
