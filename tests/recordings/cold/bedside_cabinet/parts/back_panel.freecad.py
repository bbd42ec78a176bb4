def build(part):
    part.box((0, 0, 0), ("length", "board", "height"), name="Panel")
    return part.body, {
        "left": part.connector("left", (0, 0, 0), (1, 0, 0), (0, 1, 0)),
    }
