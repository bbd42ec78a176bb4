from build123d import Align, Cylinder, PolarLocations

LOW = (Align.CENTER, Align.CENTER, Align.MIN)


def build(part):
    d = part.dimensions
    outside, thickness, face, proud, bore = d["outside"], d["thickness"], d["face"], d["proud"], d["bore"]
    hole, circle = d["hole"], d["circle"]
    shape = Cylinder(outside / 2, thickness, align=LOW) + Cylinder(face / 2, thickness + proud, align=LOW)
    shape -= Cylinder(bore / 2, 4 * thickness)
    shape -= PolarLocations(circle / 2, 4, start_angle=45) * Cylinder(hole / 2, 4 * thickness)
    return shape, {}
