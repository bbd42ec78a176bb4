def build(part):
    inside, under = "(ball_radius + clearance)", "(cap_z - wall)"
    part.sphere((0, 0, 0), "socket_radius", name="Socket")
    neck = part.sketch("XZ", name="NeckSketch")
    over = f"{under} + wall / 2"
    part.polygon(neck, [(0, 0), ("socket_radius", 0), ("0.8 * cap_radius", over), (0, over)])
    part.revolution(neck, name="Neck")
    opening = part.sketch("XZ", name="OpeningSketch")
    deep = f"(2 * {inside})"
    part.polygon(opening, [(0, 0), (0, f"-{deep}"), (f"{deep} * tan(opening_deg)", f"-{deep}")])
    part.revolution(opening, cut=True, name="Opening")
    part.sphere((0, 0, 0), inside, cut=True, name="Seat")

    slope, rim = "(mouth_radius - cap_radius) / (depth + wall)", "cap_z + depth"
    cone = part.sketch("XZ", name="ConeSketch")
    part.polygon(
        cone,
        [
            (0, under),
            ("cap_radius", under),
            ("mouth_radius", rim),
            ("mouth_radius - wall", rim),
            (f"cap_radius + {slope} * wall - wall", "cap_z"),
            (0, "cap_z"),
        ],
    )
    part.revolution(cone, name="Cone")
    return part.body, {
        "ball": part.connector("ball", (0, 0, 0), (0, 0, 1), (0, 1, 0)),
        "lamp": part.connector("lamp", (0, 0, "cap_z"), (0, 0, 1), (0, 1, 0)),
    }
