def build(part):
    part.cylinder(("-length / 2", 0, 0), "+X", "radius", "length", name="Rod")
    return part.body, {
        "seat": part.connector("seat", (0, 0, 0), (-1, 0, 0), (0, 1, 0)),
        "lid": part.connector("lid", (0, 0, 0), (-1, 0, 0), (0, 1, 0)),
    }
