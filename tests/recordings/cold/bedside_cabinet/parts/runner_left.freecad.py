def build(part):
    part.box((0, 0, 0), ("width", "length", "height"), name="Strip")
    return part.body, {
        "seat": part.connector("seat", (0, 0, 0), (1, 0, 0), (0, 1, 0)),
        "slide": part.connector("slide", ("width", 0, "height / 2"), (0, -1, 0), (1, 0, 0)),
    }
