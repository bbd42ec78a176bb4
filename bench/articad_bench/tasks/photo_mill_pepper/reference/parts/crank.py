from build123d import Align, Box, Cylinder, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    dome_diameter, dome, spindle_diameter, spindle, arm, arm_width = d["dome_diameter"], d["dome"], d["spindle_diameter"], d["spindle"], d["arm"], d["arm_width"]
    arm_thickness, pin_diameter, pin = d["arm_thickness"], d["pin_diameter"], d["pin"]
    shape = Cylinder(dome_diameter / 2, dome, align=LOW) + Cylinder(spindle_diameter / 2, spindle, align=HIGH)
    shape += Pos(0, 0, dome) * (Cylinder(arm_width / 2, arm_thickness + 6, align=LOW) + Box(arm, arm_width, arm_thickness, align=(Align.MIN, Align.CENTER, Align.MIN)))
    shape += Pos(arm, 0, dome) * (Cylinder(arm_width / 2, arm_thickness, align=LOW) + Cylinder(pin_diameter / 2, pin + arm_thickness, align=LOW))
    shape += Pos(arm, 0, dome + arm_thickness + pin) * Cylinder(pin_diameter / 2 + 2, 2, align=LOW)
    return shape, {
        "spindle": {"o": (0, 0, -0.3), "z": (0, 0, 1), "x": (1, 0, 0)},
        "pin": {"o": (arm, 0, dome+arm_thickness), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
