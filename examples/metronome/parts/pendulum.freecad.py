def build(part):
    middle = "(-hub_length - rod_thickness / 2)"  # the rod's middle plane
    part.box(("-rod_width / 2", f"{middle} - rod_thickness / 2", "-tail"), ("rod_width", "rod_thickness", "reach + tail"), name="Rod")
    pitch, half = "(reach - weight_low) / (notch_count + 1)", "sqrt(0.5)"
    notch = part.sketch("XZ", (0, middle, 0), name="NotchSketch")
    x, z = "rod_width / 2", f"weight_low + {pitch}"
    part.polygon(notch, [(f"{x} - {half}", z), (x, f"{z} - {half}"), (f"{x} + {half}", z), (x, f"{z} + {half}")])
    first = part.pocket(notch, "2 * rod_thickness", both=True, name="Notch")
    part.linear_pattern([first], "Z", f"{pitch} * (notch_count - 1)", "notch_count")

    part.cylinder((0, f"{middle} - bob_thickness / 2", "-tail"), "+Y", "bob_radius", "bob_thickness", name="Bob")
    part.cylinder((0, "-hub_length - rod_thickness", 0), "+Y", "hub_radius", "hub_length + rod_thickness", name="Hub")
    part.cylinder((0, "-hub_length", 0), "+Y", "arbor_radius", "hub_length + arbor_length", name="Arbor")
    part.cylinder((0, 0, 0), "+Y", "spigot_radius", "arbor_length + spigot_length", name="Spigot")
    return part.body, {
        "pivot": part.connector("pivot", (0, "play / 2", 0), (0, -1, 0), (0, 0, 1)),
        "rod": part.connector("rod", (0, middle, "weight_low"), (0, 0, 1), (1, 0, 0)),
        "nut": part.connector("nut", (0, "arbor_length", 0), (0, 1, 0), (1, 0, 0)),
    }
