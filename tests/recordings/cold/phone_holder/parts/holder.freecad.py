def build(part):
    part.sphere((0, 0, 0), "ball_radius", name="Ball")
    part.cylinder((0, 0, 0), "+Z", "stem_radius", "plate_z + slot_floor / 2", name="Stem")
    part.box(("-plate_length / 2", "-plate_width / 2", "plate_z"), ("plate_length", "plate_width", "plate_thickness"), name="Plate")
    part.box(("-plate_length / 2 - 1", "-slot_head_width / 2", "plate_z + slot_floor"),
             ("plate_length + 2", "slot_head_width", "plate_thickness - slot_floor - slot_lip"), cut=True, name="SlotHead")
    part.box(("-plate_length / 2 - 1", "-slot_neck_width / 2", "plate_z + slot_floor"),
             ("plate_length + 2", "slot_neck_width", "plate_thickness - slot_floor + 1"), cut=True, name="SlotNeck")
    return part.body, {
        "ball": part.connector("ball", (0, 0, 0), (0, 0, 1), (1, 0, 0)),
        "jaw_seat": part.connector("jaw_seat", ("-plate_length / 2", 0, "plate_z + plate_thickness"), (0, 0, 1), (1, 0, 0)),
        "runner": part.connector("runner", ("plate_length / 2", 0, "runner_z"), (-1, 0, 0), (0, 0, 1)),
    }
