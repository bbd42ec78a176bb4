from build123d import Align, Box, Cylinder, GridLocations, Pos

LOW = (Align.CENTER, Align.CENTER, Align.MIN)
HIGH = (Align.CENTER, Align.CENTER, Align.MAX)


def build(part):
    d = part.dimensions
    width, depth, height, board, feet, foot_diameter = d["width"], d["depth"], d["height"], d["board"], d["feet"], d["foot_diameter"]
    opening, upper, lower = d["opening"], d["upper"], d["lower"]
    shape = Box(width, depth, height, align=LOW)
    for x in (-(opening + board) / 2, (opening + board) / 2):
        for bottom, tall in ((height - board - upper, upper), (height - 2 * board - 2 * upper, upper), (board, lower - 12 + 12)):
            shape -= Pos(x, -depth / 2, bottom) * Box(opening, depth - board, tall, align=(Align.CENTER, Align.MIN, Align.MIN))
    shape += GridLocations(width - 80, depth - 80, 2, 2) * Cylinder(foot_diameter / 2, feet, align=HIGH)
    return shape, {
        "top_left": {"o": (-(opening+board)/2, -depth/2, height-board-upper), "z": (0, -1, 0), "x": (1, 0, 0)},
        "top_right": {"o": ((opening+board)/2, -depth/2, height-board-upper), "z": (0, -1, 0), "x": (1, 0, 0)},
        "middle_left": {"o": (-(opening+board)/2, -depth/2, height-2*board-2*upper), "z": (0, -1, 0), "x": (1, 0, 0)},
        "middle_right": {"o": ((opening+board)/2, -depth/2, height-2*board-2*upper), "z": (0, -1, 0), "x": (1, 0, 0)},
        "low_left": {"o": (-(opening+board)/2, -depth/2, board), "z": (0, -1, 0), "x": (1, 0, 0)},
        "low_right": {"o": ((opening+board)/2, -depth/2, board), "z": (0, -1, 0), "x": (1, 0, 0)},
    }
