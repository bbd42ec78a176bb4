from build123d import Align, Box, Cylinder, Pos, Rot

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)
SEATS = (
    ("red_keeper", -2.5),
    ("red_defence", -1.5),
    ("red_attack", 0.5),
    ("blue_keeper", 2.5),
    ("blue_defence", 1.5),
    ("blue_attack", -0.5),
)


def build(part):
    d = part.dimensions
    length, width, wall = d["length"], d["width"], d["wall"]
    floor_top = -d["pitch_board"]
    floor_bottom = floor_top - d["floor"]

    box = Pos(0, 0, d["wall_bottom"]) * Box(length + 2 * wall, width + 2 * wall, d["wall_top"] - d["wall_bottom"], align=LOW)
    box -= Pos(0, 0, floor_top) * Box(length, width, 2 * d["wall_top"], align=LOW)
    box -= Pos(0, 0, floor_bottom) * Box(length, width, 2 * d["wall_top"], align=HIGH)
    box -= Box(2 * length, d["goal_width"], d["goal_height"], align=LOW)  # both goal mouths

    connectors = {"pitch": {"o": (0, 0, floor_top), "z": (0, 0, 1), "x": (1, 0, 0)}}
    for name, place in SEATS:
        x, away = place * d["rod_pitch"], 1 if name.startswith("red") else -1
        box -= Pos(x, 0, d["axis_z"]) * Rot(X=90) * Cylinder(d["rod_radius"] + d["clearance"], 2 * width)
        connectors[name] = {"o": (x, 0, d["axis_z"]), "z": (0, away, 0), "x": (0, 0, 1)}
    for team, side in (("red", -1), ("blue", 1)):
        connectors[f"{team}_goal"] = {"o": (side * (length / 2 + wall), 0, 0), "z": (side, 0, 0), "x": (0, 0, 1)}
        connectors[f"{team}_score"] = {"o": (side * (length / 2 + wall / 2), 0, d["wall_top"]), "z": (0, 0, 1), "x": (side, 0, 0)}
    foot_x, foot_y = length / 2 - d["foot_inset"], width / 2 - d["foot_inset"]
    for i, (x, y) in enumerate(((-foot_x, -foot_y), (foot_x, -foot_y), (-foot_x, foot_y), (foot_x, foot_y)), start=1):
        connectors[f"foot_{i}"] = {"o": (x, y, floor_bottom), "z": (0, 0, 1), "x": (1, 0, 0)}
    return box, connectors
