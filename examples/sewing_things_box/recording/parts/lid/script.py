def build(part):
    part.box(("-width / 2", "-reach", "lift"), ("width", "reach - offset", "thickness"), name="Plate")
    part.box(
        ("-knuckle_length / 2", "-offset", "lift"), ("knuckle_length", "offset", "knuckle_radius - lift"), name="Tongue"
    )
    part.cylinder(("-knuckle_length / 2", 0, 0), "+X", "knuckle_radius", "knuckle_length", name="Knuckle")
    part.cylinder(
        ("-knuckle_length / 2 - 1", 0, 0), "+X", "bore_radius", "knuckle_length + 2", cut=True, name="Bore"
    )
    return part.body, {"hinge": part.connector("hinge", (0, 0, 0), (-1, 0, 0), (0, 1, 0))}
