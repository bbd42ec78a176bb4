def square(part, name, z, width):
    sketch = part.sketch("XY", (0, 0, z), name=name)
    part.rectangle(sketch, f"-({width}) / 2", f"-({width}) / 2", width, width)
    return sketch


def build(part):
    plinth = "body_width + 2 * plinth_overhang"
    part.pad(square(part, "PlinthSketch", 0, plinth), "plinth_height", name="Plinth")
    part.chamfer("+Z", "0.6 * plinth_overhang", name="PlinthEdge")
    foot, top = square(part, "BodyFoot", "plinth_height", "body_width"), square(part, "BodyTop", "height", "top_width")
    part.loft(foot, top, name="Body")

    # the front is cut away above the ledge; the cavity leaves the ledge and the upright face
    part.box(("-body_width", "-face - body_width", "ledge"), ("2 * body_width", "body_width", "height"), cut=True, name="Front")

    def inside(z):
        return f"(body_width + (top_width - body_width) * ({z} - wall) / (height - 2 * wall) - 2 * wall)"

    floor, ceiling = square(part, "CellarFloor", "wall", inside("wall")), square(part, "CellarTop", "ledge - wall", inside("(ledge - wall)"))
    part.loft(floor, ceiling, cut=True, name="Cellar")
    ends = []
    for name, z in (("RoomFloor", "ledge - wall"), ("RoomTop", "height - wall")):
        width = inside(f"({z})")
        ends.append(part.sketch("XY", (0, 0, z), name=name))
        part.rectangle(ends[-1], f"-{width} / 2", "wall - face", width, f"{width} / 2 - wall + face")
    part.loft(*ends, cut=True, name="Room")

    # bearings
    part.cylinder(("key_inside", 0, "key_height"), "+X", "boss_radius", "key_outside - key_inside", name="Boss")
    part.cylinder(("key_inside", 0, "key_height"), "+X", "key_radius + clearance", "body_width", cut=True, name="KeyBore")
    part.cylinder((0, "2 * wall - face", "pivot_height"), "-Y", "arbor_radius + clearance", "4 * wall", cut=True, name="ArborBore")
    corner = ("-slot_width / 2", "slot_y - slot_depth / 2", "ledge - 2 * wall")
    part.box(corner, ("slot_width", "slot_depth", "4 * wall"), cut=True, name="Slot")

    connectors = {
        "pivot": ((0, "pivot_y", "pivot_height"), (0, -1, 0), (0, 0, 1)),
        "key": (("key_x", 0, "key_height"), (1, 0, 0), (0, 0, 1)),
        "scale": ((0, "-face", "ledge + 3"), (0, -1, 0), (1, 0, 0)),
    }
    for row, y in (("front", "-foot_x"), ("back", "foot_x")):
        for side, x in (("left", "-foot_x"), ("right", "foot_x")):
            part.cylinder((x, y, 0), "+Z", "foot_hole_radius", "foot_hole_depth", cut=True, name=f"FootHole_{row}_{side}")
            connectors[f"foot_{row}_{side}"] = ((x, y, 0), (0, 0, 1), (1, 0, 0))
    return part.body, {name: part.connector(name, *frame) for name, frame in connectors.items()}
