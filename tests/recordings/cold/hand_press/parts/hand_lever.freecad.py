def build(part):
    part.cylinder(("-hub_back", 0, 0), "+X", "hub_radius", "hub_back + hub_front", name="Hub")
    part.box((0, "-arm_width / 2", 0), ("arm_thickness", "arm_width", "lever_radius"), name="Arm")
    part.cylinder((0, 0, "lever_radius"), "+X", "grip_radius", "grip_end", name="Grip")
    part.cylinder(("-hub_back - 1", 0, 0), "+X", "bore_radius", "hub_back + hub_front + 2", cut=True, name="ShaftBore")
    return part.body, {
        "hub": part.connector("hub", ("hub_front", 0, 0), (1, 0, 0), (0, 0, 1)),
    }
