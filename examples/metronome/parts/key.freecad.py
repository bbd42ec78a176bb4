def build(part):
    outline = part.sketch("XY", name="ShaftSketch")
    part.polygon(
        outline,
        [
            ("-shaft_length - spigot_length", 0),
            ("-shaft_length - spigot_length", "spigot_radius"),
            ("-shaft_length", "spigot_radius"),
            ("-shaft_length", "shaft_radius"),
            (0, "shaft_radius"),
            (0, "collar_radius"),
            ("collar_length", "collar_radius"),
            ("collar_length", 0),
        ],
    )
    part.revolution(outline, "H", name="Shaft")

    web = part.sketch("XZ", name="WebSketch")
    part.rectangle(web, 0, "-shaft_radius", "ear_x", "2 * shaft_radius")
    part.pad(web, "thickness", both=True, name="Web")
    for side, z in (("Lower", "-ear_offset"), ("Upper", "ear_offset")):
        ear = part.sketch("XZ", name=f"{side}EarSketch")
        part.circle(ear, "ear_x", z, "ear_radius")
        part.pad(ear, "thickness", both=True, name=f"{side}Ear")
    holes = part.sketch("XZ", name="HolesSketch")
    for z in ("-ear_offset", "ear_offset"):
        part.circle(holes, "ear_x", z, "hole_radius")
    part.pocket(holes, name="Holes")
    return part.body, {
        "shaft": part.connector("shaft", ("-play / 2", 0, 0), (1, 0, 0), (0, 0, 1)),
        "barrel": part.connector("barrel", ("-shaft_length", 0, 0), (-1, 0, 0), (0, 0, 1)),
    }
