def build(part):
    part.box(("-width / 2", 0, 0), ("width", "board", "front_height"), name="Front")
    part.box(("-width / 2", "board", "box_z"), ("width", "length - board", "box_height"), name="Box")
    part.box(("-(width / 2 - board)", "board", "box_z + board"),
             ("width - 2 * board", "length - 2 * board", "box_height - board + 1"), cut=True, name="Inside")
    part.box(("-width / 2 - 1", "groove_y", "groove_z - groove_height / 2"),
             ("groove_depth + 1", "length - groove_y + 1", "groove_height"), cut=True, name="GrooveLeft")
    part.box(("width / 2 - groove_depth", "groove_y", "groove_z - groove_height / 2"),
             ("groove_depth + 1", "length - groove_y + 1", "groove_height"), cut=True, name="GrooveRight")
    part.cylinder((0, 0, "front_height / 2"), "+Y", "knob_bore_radius", "knob_bore_depth", cut=True, name="KnobBore")
    return part.body, {
        "slide": part.connector("slide", ("-slide_x", "slide_y", "groove_z"), (0, -1, 0), (1, 0, 0)),
        "knob": part.connector("knob", (0, 0, "front_height / 2"), (0, -1, 0), (1, 0, 0)),
    }
