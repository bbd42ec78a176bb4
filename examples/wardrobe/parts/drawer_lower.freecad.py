def build(part):
    part.box(("-width / 2", 0, 0), ("width", "length", "side_height"), name="Tray")
    part.box(("-width / 2", 0, 0), ("width", "thickness", "height"), name="Front")
    part.box(("-width / 2 + side", "thickness", "floor"), ("width - 2 * side", "length - thickness - side", "height"), cut=True, name="Inside")
    for side, x in (("Left", "-width / 2"), ("Right", "width / 2 - groove_depth")):
        corner = (x, "thickness", "groove_z - groove_height / 2")
        part.box(corner, ("groove_depth", "length - thickness", "groove_height"), cut=True, name=f"{side}Groove")
    return part.body, {
        "slide": part.connector("slide", (0, 0, 0), (0, -1, 0), (1, 0, 0)),
        "handle": part.connector("handle", (0, 0, "handle_z"), (0, -1, 0), (1, 0, 0)),
    }
