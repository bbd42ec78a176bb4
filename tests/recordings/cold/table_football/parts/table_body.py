from build123d import Align, Box, Circle, Cylinder, Pos, RectangleRounded, Rot, extrude

UP = (Align.CENTER, Align.CENTER, Align.MIN)
DOWN = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    length, width = d["length"], d["width"]
    floor, wall_h = d["floor_thickness"], d["wall_height"]
    wall, end, end_h = d["side_wall"], d["end_wall"], d["end_height"]
    inner = width / 2 - wall
    end_x = length / 2 - d["tray_depth"] - end / 2
    bore = d["bore_radius"]

    shape = Box(length, width, floor, align=UP)
    for s in (-1, 1):
        shape += Pos(0, s * (width / 2 - wall / 2), 0) * Box(length, wall, wall_h, align=UP)
    for s in (-1, 1):
        shape += Pos(s * end_x, 0, 0) * Box(end, 2 * inner, end_h, align=UP)
        shape += Pos(s * (length / 2 - d["lip_thickness"] / 2), 0, 0) * Box(
            d["lip_thickness"], 2 * inner, floor + d["lip_height"], align=UP
        )
    outline = Pos(0, 0, -1) * extrude(RectangleRounded(length, width, d["corner_radius"]), amount=end_h + 2)
    shape = shape & outline

    # goal mouths
    for s in (-1, 1):
        shape -= Pos(s * end_x, 0, floor) * Box(end + 2, d["goal_width"], d["goal_height"], align=UP)

    # rod bearings, open at the top
    slot_h = wall_h - d["axis_z"] + 1
    for k in (-1.5, -0.5, 0.5, 1.5):
        x = k * d["rod_spacing"]
        for s in (-1, 1):
            y = s * (width / 2 - wall / 2)
            cutter = Pos(x, y, d["axis_z"]) * Rot(X=90) * Cylinder(bore, wall + 2)
            cutter += Pos(x, y, d["axis_z"]) * Box(2 * bore, wall + 2, slot_h, align=UP)
            shape -= cutter

    # peg holes of the rails
    for s in (-1, 1):
        for x in (-d["peg_x"], 0, d["peg_x"]):
            shape -= Pos(x, s * (width / 2 - wall / 2), wall_h - d["peg_depth"]) * Cylinder(
                d["peg_radius"], d["peg_depth"] + 1, align=UP
            )

    # leg holes
    for sx in (-1, 1):
        for sy in (-1, 1):
            shape -= Pos(sx * d["leg_x"], sy * d["leg_y"], d["leg_peg_depth"]) * Cylinder(
                d["leg_peg_radius"], d["leg_peg_depth"] + 1, align=DOWN
            )

    # pitch marks
    line_w, line_d, radius = d["line_width"], d["line_depth"], d["circle_radius"]
    marks = Pos(0, 0, floor - line_d) * extrude(
        Circle(radius + line_w / 2) - Circle(radius - line_w / 2), amount=line_d + 1
    )
    shape -= marks
    for s in (-1, 1):
        shape -= Pos(0, s * (radius + inner) / 2, floor - line_d) * Box(
            line_w, inner - radius, line_d + 1, align=UP
        )

    def frame(o, z, x):
        return {"o": o, "z": z, "x": x}

    front, back, right, left, up = (0, -1, 0), (0, 1, 0), (1, 0, 0), (-1, 0, 0), (0, 0, 1)
    sp, az = d["rod_spacing"], d["axis_z"]
    rail_y = width / 2 - wall / 2
    lx, ly = d["leg_x"], d["leg_y"]
    connectors = {
        "bearing_keeper_red": frame((-1.5 * sp, 0, az), front, right),
        "bearing_attack_blue": frame((-0.5 * sp, 0, az), back, left),
        "bearing_attack_red": frame((0.5 * sp, 0, az), front, right),
        "bearing_keeper_blue": frame((1.5 * sp, 0, az), back, left),
        "rail_front": frame((0, -rail_y, wall_h), up, right),
        "rail_back": frame((0, rail_y, wall_h), up, left),
        "leg_front_left": frame((-lx, -ly, 0), up, right),
        "leg_front_right": frame((lx, -ly, 0), up, right),
        "leg_back_left": frame((-lx, ly, 0), up, right),
        "leg_back_right": frame((lx, ly, 0), up, right),
        "score_left": frame((-end_x, -d["marker_y"], end_h), back, right),
        "score_right": frame((end_x, d["marker_y"], end_h), front, left),
        "pitch": frame((0, 0, floor), up, right),
    }
    return shape, connectors
