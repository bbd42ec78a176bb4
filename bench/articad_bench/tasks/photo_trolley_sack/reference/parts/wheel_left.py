from build123d import Cylinder, PolarLocations


def build(part):
    d = part.dimensions
    diameter, width, hub_diameter, hub, web, rim = d["diameter"], d["width"], d["hub_diameter"], d["hub"], d["web"], d["rim"]
    bore_diameter = d["bore_diameter"]
    shape = Cylinder(diameter / 2, width) - Cylinder(rim / 2, 4 * width) + Cylinder(rim / 2 + 1, web) + Cylinder(hub_diameter / 2, hub)
    shape -= PolarLocations(0.32 * rim, 6) * Cylinder(0.09 * rim, 4 * web)
    shape -= Cylinder(bore_diameter / 2, 4 * width)
    return shape, {
        "hub": {"o": (0, 0, 0), "z": (0, 0, 1), "x": (1, 0, 0)},
    }
