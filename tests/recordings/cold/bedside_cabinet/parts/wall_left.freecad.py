def build(part):
    part.box(("-board", 0, 0), ("board", "depth", "height"), name="Panel")
    return part.body, {
        "bottom": part.connector("bottom", (0, 0, 0), (1, 0, 0), (0, 1, 0)),
        "top": part.connector("top", (0, 0, "height - board"), (1, 0, 0), (0, 1, 0)),
        "shelf": part.connector("shelf", (0, 0, "shelf_z"), (1, 0, 0), (0, 1, 0)),
        "back": part.connector("back", (0, "depth - board", "board"), (1, 0, 0), (0, 1, 0)),
        "runner": part.connector("runner", (0, "runner_y", "runner_z"), (1, 0, 0), (0, 1, 0)),
    }
