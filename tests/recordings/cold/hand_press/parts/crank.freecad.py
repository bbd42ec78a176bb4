def build(part):
    part.cylinder(("disc_start", 0, 0), "+X", "disc_radius", "disc_end - disc_start", name="Disc")
    part.cylinder(("disc_end", 0, 0), "+X", "collar_radius", "collar_end - disc_end", name="ThrustCollar")
    part.cylinder(("disc_end", 0, 0), "+X", "shaft_radius", "shaft_end - disc_end", name="Shaft")
    part.cylinder(("-pin_reach", 0, "throw"), "+X", "pin_radius", "disc_end + pin_reach", name="CrankPin")
    part.cylinder(("shoulder_start", 0, "throw"), "+X", "shoulder_radius", "disc_end - shoulder_start", name="PinShoulder")
    return part.body, {
        "shaft": part.connector("shaft", ("bearing_start", 0, 0), (1, 0, 0), (0, 0, 1)),
        "pin": part.connector("pin", (0, 0, "throw"), (1, 0, 0), (0, 0, 1)),
        "lever": part.connector("lever", ("shaft_end", 0, 0), (1, 0, 0), (0, 0, 1)),
    }
