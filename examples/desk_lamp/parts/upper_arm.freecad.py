def build(part):
    outline = part.sketch("XZ", (0, "-play / 2", 0), name="BarSketch")
    part.slot(outline, (0, 0), ("length", 0), "width / 2")
    part.slot(outline, ("1.5 * width", 0), ("length - 1.5 * width", 0), "slot_width / 2")
    part.pad(outline, "thickness", name="Bar")
    part.cylinder((0, 0, 0), "-Y", "pin_radius + clearance", "play / 2 + thickness + 1", cut=True, name="Bore")

    x, z, middle = "cos(stud_angle_deg)", "sin(stud_angle_deg)", "(-play / 2 - thickness / 2)"
    neck = part.sketch("XZ", ("length", middle, 0), name="NeckSketch")
    end, aside = (f"stud_reach * {x}", f"stud_reach * {z}"), (f"-neck_radius * {z}", f"neck_radius * {x}")
    part.polygon(neck, [(0, 0), end, (f"{end[0]} + {aside[0]}", f"{end[1]} + {aside[1]}"), aside])
    part.revolution(neck, part.axis(neck, (0, 0), end), name="Neck")
    ball = (f"length + stud_reach * {x}", middle, f"stud_reach * {z}")
    part.sphere(ball, "ball_radius", name="Ball")
    return part.body, {
        "elbow": part.connector("elbow", (0, 0, 0), (0, -1, 0), (1, 0, 0)),
        "ball": part.connector("ball", ball, (x, 0, z), (0, 1, 0)),
    }
