from build123d import Align, Box, Cylinder, Pos

LOW = (Align.MIN, Align.MIN, Align.MIN)
UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def block(x0, x1, y0, y1, z0, z1):
    return Pos(x0, y0, z0) * Box(x1 - x0, y1 - y0, z1 - z0, align=LOW)


def build(part):
    d = part.dimensions
    half, height = d["thickness"] / 2, d["height"]
    lap = 1.0

    door = block(0, d["length"], -half, half, 0, height)
    door += Cylinder(half, height, align=UP)

    # pivot pins, each reaching lap into the door: lower one downwards, upper one upwards
    door += Pos(0, 0, lap) * Cylinder(d["pin_radius"], d["pin_length"] + lap, align=DOWN)
    door += Pos(0, 0, height - lap) * Cylinder(d["pin_radius"], d["pin_length"] + lap, align=UP)

    # bar handle with grip opening
    bar = d["handle_bar"]
    hx = d["length"] - d["handle_inset"]
    z0 = d["handle_z"] - d["handle_length"] / 2
    z1 = d["handle_z"] + d["handle_length"] / 2
    y0 = -half - d["handle_out"]
    handle = block(hx - bar / 2, hx + bar / 2, y0, -half + lap, z0, z1)
    handle -= block(hx - bar, hx + bar, y0 + bar, -half + 2 * lap, z0 + bar, z1 - bar)
    door += handle

    # mirror recess, open to the front
    door -= block(d["recess_x"], d["recess_x"] + d["recess_width"],
                  -half - 1, -half + d["recess_depth"],
                  d["recess_z"], d["recess_z"] + d["recess_height"])

    connectors = {
        "hinge": {"o": (0, 0, 0), "z": (0, 0, -1), "x": (1, 0, 0)},
        "mirror_seat": {
            "o": (d["recess_x"] + d["recess_width"] / 2, -half + d["recess_depth"],
                  d["recess_z"] + d["recess_height"] / 2),
            "z": (0, -1, 0), "x": (1, 0, 0)},
    }
    return door, connectors
