from build123d import Cylinder, PolarLocations, Sphere


def build(part):
    d = part.dimensions
    pitch, thickness, height, ball, ball_count = d["pitch"], d["thickness"], d["height"], d["ball"], d["ball_count"]
    shape = Cylinder((pitch + thickness) / 2, height) - Cylinder((pitch - thickness) / 2, 4 * height)
    shape += PolarLocations(pitch / 2, ball_count) * Sphere(ball / 2)
    return shape, {"outer": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)}}
