def build(part):
    part.box(("-width / 2", 0, 0), ("width", "length", "height"), name="Block")
    part.box(
        ("-width / 2 + wall", "wall", "wall"), ("width - 2 * wall", "length - 2 * wall", "height"), cut=True, name="Inside"
    )
    part.cylinder((0, -1, "height / 2"), "+Y", "bore_radius", "wall + 1", cut=True, name="KnobBore")
    return part.body, {
        "slide": part.connector("slide", (0, 0, 0), (0, -1, 0), (1, 0, 0)),
        "knob": part.connector("knob", (0, 0, "height / 2"), (0, -1, 0), (1, 0, 0)),
    }
