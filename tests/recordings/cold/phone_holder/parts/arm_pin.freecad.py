def build(part):
    part.cylinder((0, "-length / 2", 0), "+Y", "radius", "length", name="Pin")
    return part.body, {
        "end": part.connector("end", (0, "-length / 2", 0), (0, -1, 0), (1, 0, 0)),
    }
