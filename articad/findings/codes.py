"""The vocabulary of findings: every code with its stage, who must act, and what it means.

`docs/reference/findings.md` is generated from this table. A code that is not listed here cannot be used
(`Finding` looks it up), and a test fails on one that no other test raises.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

Stage = Literal["plan", "build", "interference", "motion", "fit", "export", "import", "audit", "model"]
Route = Literal["design", "code"]


class Code(NamedTuple):
    """A registered code.

    Attributes:
        stage: The check that reports it.
        route: Who must act: the plan's author (design), the part script's (code), or neither.
        meaning: What was found.
        remedy: What to do about it, in general; each finding's own hint is particular.
    """

    stage: Stage
    route: Route | None
    meaning: str
    remedy: str


CODES: dict[str, Code] = {
    # --- plan: form and numbers
    "E_SCHEMA": Code(
        "plan", "design", "The plan does not have the form of articad.plan/1.", "Correct the named field; the valid ones are listed."
    ),
    "E_NAME": Code(
        "plan",
        "design",
        "A name does not have the allowed form.",
        "Use lower_snake_case with at most 40 characters, no Python keyword and no double underscore.",
    ),
    "E_DUP_NAME": Code("plan", "design", "A name is used twice in its own list.", "Rename one of them."),
    "E_EXPRESSION": Code(
        "plan",
        "design",
        "A number's expression cannot be read.",
        "Use + - * / ( ), decimal literals, parameter names, pi and the listed functions.",
    ),
    "E_EXPRESSION_CYCLE": Code(
        "plan", "design", "Parameters depend on each other in a cycle.", "Give one of the parameters in the cycle a number."
    ),
    "E_NONFINITE": Code(
        "plan", "design", "A number is not finite.", "Give a finite number; check for division by zero and roots of negative numbers."
    ),
    "E_PARAMETER_BOUNDS": Code("plan", "design", "A parameter's value is outside its own min and max.", "Move the value or the bound."),
    "E_PARAMETER_UNKNOWN": Code("plan", "design", "A value is given for a parameter that is not declared.", "Use one of those listed."),
    "W_PARAMETER_RANGE": Code(
        "plan",
        "design",
        "The plan breaks when a parameter is at its min or max.",
        "Narrow the parameter's range, or correct the expression that fails.",
    ),
    "E_MATERIAL_UNKNOWN": Code(
        "plan", "design", "A part names a material that is not declared.", "Declare the material or correct its name."
    ),
    "E_COUNT": Code("plan", "design", "A dimension that ends in _count is not a whole number.", "Give a whole number."),
    "E_DENSITY": Code("plan", "design", "A density is not positive.", "Give the density in kg/m3; steel is 7850."),
    "W_DENSITY": Code(
        "plan", "design", "A density is one that no material has.", "Give the density in kg/m3, not in g/cm3; steel is 7850."
    ),
    "E_FRICTION": Code("plan", "design", "A friction coefficient is negative.", "Give a coefficient of at least 0; wood on wood is 0.4."),
    "E_ENVELOPE_VALUE": Code(
        "plan", "design", "An expected bounding box has a side that is not positive.", "Give three positive lengths in mm."
    ),
    "E_SCALE": Code(
        "plan",
        "design",
        "The assembly is smaller than 0.5 mm or larger than 1e6 mm.",
        "Lengths are millimetres; were metres or inches meant?",
    ),
    "W_SCALE": Code(
        "plan",
        "design",
        "A dimension is thinner than anything that is made, or far longer than all others of the plan.",
        "Lengths are millimetres; were metres, inches or micrometres meant?",
    ),
    "W_DIMENSION_SIGN": Code(
        "plan", "design", "A dimension that is named as a size is negative.", "Make it positive, or name a place as one, such as hole_z."
    ),
    "W_MOTION_RANGE": Code(
        "plan",
        "design",
        "No joint goes about as far as the analysis of the request says that something moves.",
        "Correct the limits of the joint, or keep them where the analysis is what is wrong.",
    ),
    "E_NOT_SUPPORTED": Code(
        "plan", "design", "The plan is valid, but this version cannot solve it yet.", "Use a supported joint type or structure."
    ),
    # --- plan: connectors
    "E_AXIS_ZERO": Code("plan", "design", "An axis has no length.", "Give a vector longer than 1e-9."),
    "E_AXIS_PARALLEL": Code("plan", "design", "A connector's x is parallel to its z.", "Give an x perpendicular to z, or leave x out."),
    "E_AXIS_NOT_ORTHOGONAL": Code(
        "plan", "design", "A connector's x is more than 1 degree off perpendicular to z.", "Use the projected x that the hint states."
    ),
    "W_AXIS_NOT_ORTHOGONAL": Code(
        "plan",
        "design",
        "A connector's x is not exactly perpendicular to z and was projected.",
        "Use the projected x that the hint states.",
    ),
    "E_LEFT_HANDED": Code("plan", "design", "A frame is mirrored: its determinant is negative.", "Use derive: mirror for mirrored parts."),
    "E_NOT_ROTATION": Code("plan", "design", "A matrix is not a rotation.", "Give orthonormal columns with determinant 1."),
    "E_QUAT_NORM": Code("plan", "design", "A quaternion is not of unit length.", "Give a unit quaternion (x, y, z, w)."),
    "E_CONNECTOR_UNKNOWN": Code(
        "plan", "design", "A joint names a connector that its part does not declare.", "Declare the connector or use one of those listed."
    ),
    "W_CONNECTOR_KIND": Code(
        "plan", "design", "A connector's kind does not suit its joint.", "Use a kind that suits the joint, or 'frame'."
    ),
    "W_CONNECTOR_UNUSED": Code("plan", "design", "No joint uses this connector.", "Use it in a joint, or remove it."),
    "W_DUP_CONNECTOR_USE": Code(
        "plan", "design", "Two joints use one connector.", "This is correct for coaxial stacks; otherwise declare a separate connector."
    ),
    "E_NO_CONNECTORS": Code(
        "plan", "design", "A part of an assembly has no connector.", "Declare at least one connector and a joint that uses it."
    ),
    # --- plan: joints and graph
    "E_PART_UNKNOWN": Code("plan", "design", "A name refers to a part that is not declared.", "Declare it, or use one of those listed."),
    "E_JOINT_UNKNOWN": Code("plan", "design", "A name refers to a joint that is not declared.", "Declare it, or use one of those listed."),
    "E_ENVIRONMENT": Code(
        "plan",
        "design",
        "A part of the environment is the ground, moves, or carries another part.",
        "Make it the child of one fixed joint to a part of the product.",
    ),
    "E_JOINT_SELF": Code("plan", "design", "A joint connects a part with itself.", "Name two different parts."),
    "E_JOINT_DUP": Code("plan", "design", "Two joints connect the same two connectors.", "Remove one."),
    "E_NO_GROUND": Code("plan", "design", "The ground is not one of the parts.", "Name a declared part as ground."),
    "E_DISCONNECTED": Code(
        "plan",
        "design",
        "Some parts are not connected to the ground.",
        "Add a joint between one part of each group and one that is connected.",
    ),
    "E_NOT_TREE": Code(
        "plan",
        "design",
        "The plan asserts a tree but its joints close a loop.",
        "Remove the joint that closes the loop, or drop 'tree': true.",
    ),
    "E_REVERSE_UNSUPPORTED": Code(
        "plan", "design", "The tree would have to traverse a planar or universal joint from child to parent.", "Swap its parent and child."
    ),
    "E_DOF_MISMATCH": Code(
        "plan",
        "design",
        "The declared freedoms differ from those the joints give.",
        "Set freedoms to the computed number, or correct the joints.",
    ),
    "E_DRIVER": Code(
        "plan",
        "design",
        "The declared drivers do not determine the motion.",
        "Mark one independent joint as driver for each freedom.",
    ),
    "W_DRIVER": Code("plan", "design", "A driver mark has no effect here.", "Remove it."),
    "E_LIMITS_MISSING": Code("plan", "design", "A joint that moves has no limits.", "Give [lower, upper], or 'endless' for an angle."),
    "E_LIMITS_ORDER": Code("plan", "design", "The lower limit is above the upper limit.", "Swap the two."),
    "E_LIMITS_KIND": Code("plan", "design", "A limit does not suit its joint.", "Use the fields of the joint's own type."),
    "W_LIMITS_EQUAL": Code("plan", "design", "A joint's two limits are equal, so it cannot move.", "Use a fixed joint, or open the range."),
    "W_LIMITS_UNITS": Code("plan", "design", "Limits of a rotary joint look like radians, or exceed two turns.", "Give degrees."),
    "E_REST_OUTSIDE_LIMITS": Code("plan", "design", "A joint's rest value is outside its limits.", "Move the rest value or the limit."),
    "E_EFFORT": Code(
        "plan",
        "design",
        "An effort or velocity is not positive, or does not suit its joint.",
        "Give a positive number in the unit of a freedom that the joint has, or leave it out.",
    ),
    "E_LEAD_ZERO": Code("plan", "design", "A screw has no lead.", "Give the advance per turn in mm, or use a revolute joint."),
    "E_MATE_OFFSET": Code(
        "plan", "design", "The two connectors of a joint do not meet at rest.", "Move one of them by the stated offset, or set rest_pose."
    ),
    "E_MATE_FLIP": Code(
        "plan",
        "design",
        "The two z axes of a joint oppose at rest although the mate is aligned, or agree although it is opposed.",
        "Change the mate, or reverse one z.",
    ),
    "E_MATE_TILT": Code(
        "plan", "design", "The two z axes of a joint are tilted against each other at rest.", "Use the corrected z that the hint states."
    ),
    "E_MATE_ROLL": Code(
        "plan",
        "design",
        "The two x axes of a joint differ at rest: the part would be turned about the axis.",
        "Use the corrected x, or set the rest value.",
    ),
    "I_REST_AUTO": Code(
        "plan",
        None,
        "A joint places the part, so the rest check of that joint is always satisfied.",
        "Give the part a rest_pose if you want the check.",
    ),
    "E_REST_AUTO": Code(
        "plan",
        "design",
        "No joint can place the part: it is the ground, or the connector that would place it is given in the assembly frame.",
        "Give the part a rest_pose, or leave it out.",
    ),
    # --- plan: derived parts and joints
    "E_DERIVE_UNKNOWN": Code("plan", "design", "A derived part or joint names a source that is not declared.", "Use one of those listed."),
    "E_DERIVE_CYCLE": Code(
        "plan", "design", "Derived parts or joints derive from each other in a cycle.", "Give one of them its own definition."
    ),
    "E_DERIVE_COUNT": Code("plan", "design", "A pattern's count is not a positive whole number.", "Give a whole number of at least 1."),
    "E_DERIVE_JOINT": Code(
        "plan",
        "design",
        "A derived joint's child is not the image of its source's child.",
        "Name the part that is derived by the same operation.",
    ),
    "W_MIRROR_LIMITS": Code(
        "plan",
        "design",
        "A mirrored part's joint has the limits of its source, so the motion is not symmetric.",
        "Derive the joint as well, or negate and swap the limits.",
    ),
    "W_CHIRAL": Code(
        "plan",
        "design",
        "A mirrored part seems to have a handedness (thread, gear, text).",
        "Make it a separate part, unless the opposite hand is intended.",
    ),
    "I_MIRROR_SIDE": Code(
        "plan",
        None,
        "A mirrored part keeps connector names or labels that contain left or right.",
        "Nothing needs to be done, or name the source's connectors without a side.",
    ),
    # --- plan: couplings, fits, waivers, mechanisms
    "E_COUPLING": Code(
        "plan",
        "design",
        "A coupling's joints do not suit its type.",
        "Name one coordinate of each joint, of the kind that the coupling requires.",
    ),
    "E_COUPLING_AXES": Code(
        "plan", "design", "A coupling's axes are not parallel at rest.", "Use a linear coupling, or make the axes parallel."
    ),
    "E_COUPLING_RATIO": Code(
        "plan", "design", "A coupling's ratio is zero or not finite.", "Give positive teeth or radii, or a ratio other than zero."
    ),
    "E_COUPLING_REST": Code(
        "plan", "design", "A linear coupling's offset does not agree with the rest values.", "Set the offset to the named value."
    ),
    "E_COUPLING_LOCKED": Code(
        "plan",
        "design",
        "Couplings lock each other, such as three gears in a triangle.",
        "Remove one of them, or correct a ratio: around a closed train, the product of the ratios must be 1.",
    ),
    "E_FIT": Code(
        "plan",
        "design",
        "A fit's range is impossible, or its name is unknown or unsuitable.",
        "Give 0 <= min <= max in mm, or a name such as H7/g6 or sliding.",
    ),
    "E_ALLOW": Code("plan", "design", "A waiver is incomplete.", "Name two different parts, a positive depth in mm and a reason."),
    "E_LOOP_OPEN": Code("plan", "design", "A loop cannot be closed.", "Lengthen a link or move a pivot."),
    "W_LOOP_INEXACT": Code(
        "plan",
        "design",
        "A loop closes and moves only after a correction of its connectors within the tolerance, because they are rounded.",
        "Give the named connectors with more digits, or accept the correction.",
    ),
    "E_LOOP_LOCKED": Code("plan", "design", "A loop cannot move.", "Make the axes parallel, or change a joint of the loop."),
    "E_LOOP_LIMIT": Code(
        "motion",
        "design",
        "A joint of a loop leaves its limits while the driver moves.",
        "Narrow the driver's limits or widen the joint's.",
    ),
    "E_DEAD_POINT": Code("motion", "design", "A driver's declared range goes past a dead point of the loop.", "Set the named limits."),
    "E_SINGULAR": Code(
        "motion",
        "design",
        "The mechanism passes a singular configuration where its branch is not determined.",
        "Keep the driver away from the named value.",
    ),
    "E_NO_PATH": Code(
        "motion",
        "design",
        "No path of the drivers between two configurations was found on the branch and within limits.",
        "Give waypoints, or widen limits.",
    ),
    "E_REACH_BARRED": Code(
        "motion",
        "design",
        "The target can be reached only in configurations in which parts overlap.",
        "Move the target or the obstacle.",
    ),
    "E_NOT_FOLLOWED": Code(
        "motion",
        "design",
        "The solver stopped following a linkage, at its limit of steps or because the constraints have a multiple root; no obstacle is known.",
        "Ask for a value nearer to rest, or give the driver limits.",
    ),
    "W_NEAR_SINGULAR": Code(
        "motion", "design", "A loop is close to a singular configuration.", "Check for a misaligned axis or a dead point."
    ),
    "W_SHAKY": Code(
        "plan",
        "design",
        "The linkage can move to first order only: it is rigid, but shaky.",
        "Change a length, so that it moves or is clearly rigid.",
    ),
    "W_IDLE_FREEDOM": Code(
        "plan", "design", "A freedom moves one part alone and drives nothing.", "This is correct for a leg that may spin; otherwise fix it."
    ),
    "I_REDUNDANT": Code(
        "plan",
        None,
        "A closed loop is held more often than its motion needs, so that only exact parts fit without play.",
        "The plan may stay as it is. In the real mechanism, leave its joints some play, or change the named joints to ball or cylindrical ones.",
    ),
    # --- build
    "E_SCRIPT_MISSING": Code("build", "code", "A part has no script.", "Write parts/<part>.py with a function build(part)."),
    "E_ORDER_REFUSED": Code(
        "build",
        "design",
        "The author of a part states that it cannot be built as specified.",
        "Correct the number or the description that the author names; or state how both hold.",
    ),
    "E_SCRIPT_ERROR": Code("build", "code", "A part script raised an exception.", "Correct the named line."),
    "E_SCRIPT_TIMEOUT": Code("build", "code", "A part script ran too long.", "Simplify the geometry; look for an endless loop."),
    "E_SCRIPT_MEMORY": Code("build", "code", "A part script needed too much memory.", "Simplify the geometry."),
    "E_SCRIPT_FORBIDDEN": Code(
        "build",
        "code",
        "A part script did something that the sandbox forbids.",
        "A script may only compute a shape: no files, network, processes.",
    ),
    "E_NO_BUILD": Code(
        "build",
        "code",
        "A part script does not define build(part), or it does not return (shape, connectors).",
        "Define build(part) and return (shape, connectors).",
    ),
    "E_NOT_ONE_SOLID": Code("build", "code", "The shape is not one solid.", "Make the bodies overlap or touch, and fuse them."),
    "E_INVALID_SOLID": Code("build", "code", "The solid is not valid.", "Avoid self-intersecting features and zero-thickness walls."),
    "W_PART_STEP": Code(
        "build",
        "code",
        "A solid is valid, but not once it is written as STEP.",
        "Do not let a round face only touch another face: move one of them by 0.1 mm.",
    ),
    "E_EMPTY_SOLID": Code("build", "code", "The solid has no volume.", "Check that cuts do not remove everything."),
    "E_ENVELOPE": Code("build", "code", "The solid's bounding box differs from the stated one by more than 2 %.", "Build the stated size."),
    "E_CONNECTOR_MISSING": Code(
        "build", "code", "The script does not return a connector of the plan.", "Return an entry for each connector of the plan."
    ),
    "E_CONNECTOR_EXTRA": Code(
        "build", "code", "The script returns a connector that the plan does not have.", "Return only the connectors of the plan."
    ),
    "E_CONNECTOR_DRIFT": Code(
        "build",
        "code",
        "A realised connector is too far from its position in the plan.",
        "Build the feature where the plan's connector is.",
    ),
    "W_CONNECTOR_DRIFT": Code(
        "build", "code", "A realised connector is slightly off the plan's.", "Build the feature where the plan's connector is."
    ),
    "E_CONNECTOR_FEATURE": Code(
        "build",
        "design",
        "No script built the bore, shaft or face that a connector's kind orders.",
        "Describe the feature at the connector, or give the connector the kind 'frame'.",
    ),
    "W_PART_SCALE": Code(
        "build",
        "code",
        "Several dimensions of a part are far longer than the part itself.",
        "Build the part in millimetres, with the dimensions as they are given.",
    ),
    "W_CONNECTOR_FEATURE": Code(
        "build",
        "code",
        "A connector's kind orders a bore, a shaft or a face that the part does not have there.",
        "Build the feature where the connector is; or give the connector the kind 'frame'.",
    ),
    "W_RADIUS_MISTAKEN": Code(
        "build",
        "code",
        "No round face of a part has the radius that a dimension states, and one has twice or half of it.",
        "Use the dimension as what it is: a radius, or a diameter.",
    ),
    "W_BORE_NARROW": Code("build", "design", "A bore is too narrow and deep to be drilled or printed.", "Widen it, or leave it out."),
    "E_NOT_EDITABLE": Code(
        "build",
        "code",
        "The part cannot be edited: its dimensions do not drive it.",
        "Use the dimensions in the geometry instead of literal numbers.",
    ),
    "E_FEATURE_OFF_TIP": Code(
        "build",
        "code",
        "A feature of the body is not part of its final solid.",
        "Set body.Tip to the pattern before adding the next feature.",
    ),
    "W_DIMENSION_UNUSED": Code(
        "build", "code", "A stated dimension does not change the part.", "Use the dimension in the script, or remove it from the plan."
    ),
    "W_DIMENSION_REFUSED": Code(
        "build",
        "code",
        "The script refuses a small change of a dimension.",
        "Let the script accept every value that can be built, or derive dependent dimensions in the plan.",
    ),
    "W_BUILD_UNCHECKED": Code(
        "build", "code", "A check of the built part was not finished in time.", "Simplify the part, or give the kernel more time."
    ),
    "I_BUILD_UNCHECKED": Code(
        "build",
        None,
        "The kernel cannot decide whether the faces of a solid intersect.",
        "Check that volume and pictures look right.",
    ),
    "E_SANDBOX": Code(
        "build",
        None,
        "The sandbox that untrusted scripts need is not available.",
        "Install the named programs, or accept weaker isolation with --sandbox weak.",
    ),
    "E_KERNEL_UNAVAILABLE": Code(
        "build",
        None,
        "The kernel that builds parts is not available.",
        "Install the named programs; `articad doctor` shows what is installed.",
    ),
    "E_FREECAD": Code(
        "export",
        None,
        "FreeCAD failed on a document, or found invalid objects in it, or a shape that differs from the part's.",
        "Do not use the document; export STEP instead.",
    ),
    "W_FREECAD_SOLVER": Code(
        "export",
        None,
        "FreeCAD's own solver does not agree with the exact placements that were written.",
        "The file is correct; do not let FreeCAD move the parts.",
    ),
    "I_FREECAD_UNSEEN": Code(
        "export",
        None,
        "A FreeCAD document was written without FreeCAD, so its solver did not check it.",
        "Open it in FreeCAD 1.0 or later. Install FreeCAD to write feature trees as well; up to 500 parts it checks the document.",
    ),
    "E_FREECAD_JOINT": Code(
        "import",
        None,
        "A joint of a FreeCAD document has a type that articad does not support.",
        "Use Fixed, Revolute, Slider, Cylindrical, Ball, Gears, Belt, RackPinion or Screw, or suppress the joint.",
    ),
    "W_FREECAD_LOOSE": Code(
        "import", None, "No joint connects a part of a FreeCAD document to the grounded part.", "Connect it with a joint in FreeCAD."
    ),
    "W_FREECAD_ELSEWHERE": Code(
        "import",
        None,
        "A part of a FreeCAD document is not where its joints put it.",
        "Solve the assembly in FreeCAD and save it.",
    ),
    "W_FREECAD_APART": Code(
        "import",
        None,
        "A joint of a FreeCAD document does not hold where its parts stand in the document.",
        "Correct the faces that the joint refers to, and solve the assembly in FreeCAD.",
    ),
    "I_FREECAD_EDIT": Code(
        "import", None, "A FreeCAD document was changed after articad wrote it; articad adopts the change.", "Nothing needs to be done."
    ),
    "W_FREECAD_EDIT": Code(
        "import",
        None,
        "A FreeCAD document was changed after articad wrote it; articad does not adopt the change.",
        "Make the change in the plan or a part script, or keep the document.",
    ),
    "W_FREECAD_SHAPE": Code("import", None, "The shape of a FreeCAD part is not made of valid solids.", "Repair it in FreeCAD."),
    # --- interference and fits
    "E_OVERLAP": Code("interference", "design", "Two parts overlap at rest.", "Move one of them, or shorten it."),
    "W_STATIC_OVERLAP": Code(
        "interference", "code", "Two parts that a joint connects overlap more than a fit allows.", "Enlarge the bore or thin the pin."
    ),
    "E_STATIC_OVERLAP": Code(
        "interference",
        "code",
        "Two parts that a joint connects overlap by more than 1 % of the smaller.",
        "Bore the hole, or cut the slot.",
    ),
    "E_MOTION_COLLISION": Code(
        "motion", "design", "Two parts collide during motion.", "Narrow the limits to the free range, or add clearance."
    ),
    "E_FLOATING": Code("interference", "design", "A part touches nothing.", "Move it to its neighbour, or connect it."),
    "E_NOT_TOUCHING": Code(
        "interference", "code", "Two parts that are fixed to each other do not touch.", "Extend one of them to the other."
    ),
    "E_MESH_OPEN": Code(
        "interference",
        "code",
        "A mesh is not closed, so overlap cannot be measured.",
        "Repair the mesh; every edge must belong to two triangles.",
    ),
    "I_WAIVED": Code(
        "interference", None, "An overlap is allowed by a waiver of the plan.", "Nothing needs to be done as long as the reason holds."
    ),
    "E_CERTIFICATE_REFUTED": Code(
        "interference", None, "The independent checker refutes a certificate that the prover accepts.", "Report it with the plan."
    ),
    "E_NOT_CHECKED": Code("interference", None, "A requested check was not done.", "Give it a larger budget, or what it requires."),
    "I_NOT_SAMPLED": Code(
        "motion",
        None,
        "Sampling leaves out part of what a mechanism can do.",
        "Nothing needs to be done, or check the named motion separately.",
    ),
    "W_NOT_INSERTABLE": Code(
        "interference",
        "design",
        "No order was found in which parts get to their places one after the other, in one or two straight moves each.",
        "Open one side, split a part, or let it snap or rotate into place.",
    ),
    "W_NOT_CERTIFIED": Code(
        "motion", "design", "Two parts are too close to prove that their motion is free; it was sampled.", "Give them a clearance."
    ),
    "E_TOLERANCE": Code(
        "motion",
        "design",
        "Two parts are clear as modelled, but can meet when their surfaces lie elsewhere within their tolerance.",
        "Widen the gap, choose a finer class, or declare the fit of the joint.",
    ),
    "E_FIT_TIGHT": Code(
        "fit", "code", "A joint's gap is smaller than its fit allows.", "Enlarge the bore or thin the pin by the named amount."
    ),
    "E_FIT_LOOSE": Code(
        "fit", "code", "A joint's gap is larger than its fit allows.", "Narrow the bore or thicken the pin by the named amount."
    ),
    "W_FIT_UNRESOLVED": Code(
        "fit", "design", "The meshes are too coarse to decide whether a fit is met.", "Mesh the two parts with a smaller deflection."
    ),
    "W_FIT_NOMINAL": Code(
        "fit", "design", "A bore's diameter differs from the nominal diameter of its fit.", "State the fit for the bore's diameter."
    ),
    "E_FIT_CONTACT": Code(
        "fit", "design", "Contact is forbidden but found, or required but absent.", "Move the surfaces by the named amount."
    ),
    "W_JOINT_NOT_MADE": Code(
        "fit", "design", "No surfaces of two parts form the joint between them.", "Give one part a pin and the other its bore, or a guide."
    ),
    "W_JOINT_PARTLY_MADE": Code(
        "fit",
        "design",
        "The surfaces of a joint leave motions free that the joint should block.",
        "Add surfaces that stop the named motions.",
    ),
    "W_JOINT_LEAVES": Code(
        "fit",
        "design",
        "Surfaces that form a joint at rest no longer form it elsewhere in its range.",
        "Lengthen the guide or the pin, or shorten the range.",
    ),
    "W_NOT_CARRIED": Code(
        "fit", "design", "Nothing carries a part against its weight.", "Put a surface under it, or give it a joint whose surfaces hold it."
    ),
    "W_TIPS_OVER": Code(
        "fit",
        "design",
        "The product's centre of mass is not over the points on which it stands.",
        "Widen the base, move mass over it, or shorten the travel.",
    ),
    "W_JOINT_SHORT": Code(
        "fit", "design", "A slide has too little of its guide engaged at an end of its range.", "Lengthen the guide, or shorten the travel."
    ),
    "W_HOLES_APART": Code(
        "fit",
        "design",
        "Holes of two parts that are fixed to each other should meet where their faces touch, and each faces solid material.",
        "Move one of the two to the named place.",
    ),
    # --- model
    "E_REPLY_SCHEMA": Code(
        "model",
        None,
        "A model's reply does not have the required form.",
        "The reply and the form are shown; the request is repeated with the findings.",
    ),
    "W_LOOK_SHAPE": Code(
        "model",
        "code",
        "A model that saw pictures of a part reports that its shape differs from the specification.",
        "Compare the pictures with the plan.",
    ),
    "W_LOOK_PROPORTION": Code(
        "model",
        "code",
        "A model that saw pictures of a part reports that its proportions differ from the specification.",
        "Compare the pictures with the plan.",
    ),
    "W_LOOK_ORIENTATION": Code(
        "model",
        "code",
        "A model that saw pictures of a part reports that it is rotated or mirrored relative to the specification.",
        "Compare the pictures with the plan.",
    ),
    "I_LOOK_UNSEEN": Code(
        "model", None, "A model that saw pictures of a part lists what none of them shows.", "Nothing: it was not judged."
    ),
    "W_OBSERVER_UNSEEN": Code(
        "model",
        None,
        "An observer of an assembly did not see a part or a motion, not even with what hides it drawn as glass.",
        "Look at it yourself: nobody has agreed to it.",
    ),
    "E_VERDICT_PLACEMENT": Code(
        "model", None, "The judge finds parts missing, misplaced or of the wrong appearance.", "Compare with what the finding expects."
    ),
    "E_VERDICT_INTERFERENCE": Code(
        "model", None, "The judge finds interference that no exact check covered.", "Compare with what the finding expects."
    ),
    "E_VERDICT_MOTION": Code(
        "model", None, "The judge finds that the product does not move as requested.", "Compare with what the finding expects."
    ),
    "I_OVERRULED": Code(
        "model",
        None,
        "A model's opinion was discarded because an exact check contradicts it.",
        "Nothing: geometry decides what can be measured.",
    ),
    "W_ALTERNATIVES": Code(
        "model", None, "A model had fewer structurally distinct ideas than requested.", "Choose one of them, or ask again."
    ),
    "W_STALLED": Code(
        "model",
        None,
        "The same finding came back after every strategy; nothing more was tried.",
        "Correct the plan or the script by hand, or ask again.",
    ),
    "I_ABSORBED": Code(
        "model", None, "A script placed a connector slightly off the plan; a new version of the plan adopts its position.", "Nothing."
    ),
    "E_EDIT_REACH": Code(
        "model",
        "design",
        "An edit changes a part that it must not touch.",
        "Name the part, or make a smaller change, such as the part's own number instead of a shared parameter.",
    ),
    "E_EDIT_UNEQUAL": Code(
        "model",
        None,
        "A part that an edit does not touch has different files than before.",
        "Replay the run that was edited: it was made on another machine, or its files were changed by hand.",
    ),
    "I_EDITED": Code("model", None, "An edit has changed a value of the plan.", "Nothing."),
    "I_PART_EDITED": Code("model", None, "An edit has changed a part, or added or removed it.", "Nothing."),
    "E_REPLAY_MISS": Code(
        "model", None, "The recording has no reply for this request.", "Replay with the version that recorded it, or record again."
    ),
    "I_PROMPT_DRIFT": Code(
        "model", None, "A prompt differs from the recorded one; the recorded reply was used.", "Record again, or use --strict to refuse."
    ),
    "W_REPLAY_DRIFT": Code(
        "model",
        None,
        "A replay's geometry differs by rounding, because of another kernel, version or platform.",
        "Nothing needs to be done, or record again.",
    ),
    "E_REPLAY_DIFFERS": Code(
        "model", None, "A replay made different files than the recording.", "Replay with the versions that recorded it, or record again."
    ),
    "E_BUDGET": Code("model", None, "The budget is spent.", "Raise --max-calls, --max-cost or --max-minutes, and resume."),
    "E_TRANSPORT": Code("model", None, "The model could not be reached.", "Check --api-base, the network and the provider's status."),
    "E_KEY_MISSING": Code("model", None, "The provider's key is missing or was refused.", "Set the named environment variable."),
    # --- import and export
    "E_UNREPRESENTABLE": Code(
        "export",
        None,
        "A format cannot represent something, and strict was requested.",
        "Export without --strict to accept the named loss.",
    ),
    "E_WRITE": Code(
        "export", None, "A file cannot be written.", "Check free space and permissions at the named place; finished work is kept."
    ),
    "E_RUN": Code("import", None, "A run directory cannot be used.", "Name another directory, or wait for the process that uses it."),
    "W_PRINT_CLEARANCE": Code(
        "export",
        "design",
        "A joint's gap between parts that may be printed is smaller than the process needs.",
        "Widen the gap, or use another process.",
    ),
    "E_MIMIC_FIT": Code(
        "export", None, "A closed loop cannot be written as mimic joints within 0.1 mm.", "Use another way to write loops, or MJCF."
    ),
    "I_EFFORT_ASSUMED": Code(
        "export",
        None,
        "The effort, velocity or damping of a joint is computed, because the input does not state it.",
        "State it if the drive is known.",
    ),
    "E_REPLACES": Code(
        "export", None, "A file to be written would replace one that belongs to something else.", "Write into another folder."
    ),
    "E_READ": Code("import", None, "A file cannot be read.", "Check the file at the named place."),
    "W_IMPORT_STALE": Code(
        "import",
        None,
        "A file was edited after articad wrote it, or its records do not describe it, so they are not used.",
        "Edit the plan and export again.",
    ),
    "W_IMPORT_MESH": Code(
        "import", None, "A mesh of a foreign file is left out.", "Put the mesh where the file names it, or allow its folder."
    ),
    "W_IMPORT_LIMITS": Code(
        "import", None, "A joint's limits in a foreign file are missing or reversed.", "Give lower and upper in the file."
    ),
    "W_IMPORT_LOOP": Code(
        "import",
        None,
        "A link of a URDF is the child of several joints, which other readers refuse or read as a tree.",
        "Keep one of the joints.",
    ),
    "W_IMPORT_DROPPED": Code(
        "import", None, "Something in a foreign file has no counterpart and is left out.", "Nothing needs to be done if it is not needed."
    ),
    "W_IMPORT_MUJOCO": Code("import", None, "MuJoCo accepts a model with a warning.", "Correct what the warning names."),
    "I_IMPORT_CHAIN": Code(
        "import",
        None,
        "A chain of joints over links without shape, or what closes a loop, could be read as one joint.",
        "Read with fuse to merge them.",
    ),
    "I_IMPORT_FUSED": Code(
        "import",
        None,
        "A chain of joints over links without shape, or what closes a loop, is read as one joint.",
        "Read without fuse to keep them apart.",
    ),
    "I_ADOPT_MERGED": Code(
        "import",
        None,
        "A part without shape is fixed to another part and is merged into it in the adopted plan.",
        "Nothing needs to be done if it is a frame.",
    ),
    "I_ADOPT_FITS": Code("import", "design", "Joints of an adopted file have no fits.", "Declare the play of each joint in the plan."),
    "W_ADOPT_SHAPE": Code(
        "import", "code", "An adopted part's script differs from its mesh.", "Redraw the part in its script from the mesh."
    ),
    "W_ADOPT_PLACEHOLDER": Code(
        "import", "code", "An adopted part has no shape; a small ball represents it.", "Draw the part in its script."
    ),
    "W_ADOPT_UNTRIED": Code(
        "import", None, "The parts of an adopted file were not built, so it is not known whether they build.", "Build the folder."
    ),
    "E_UNSAFE_PATH": Code("import", None, "A file names a path outside its own folder.", "Keep meshes beside the file."),
    # --- audit and simulation of files that anyone made
    "E_AUDIT_NUMBER": Code(
        "audit", None, "An attribute is not a number, or has an impossible value.", "Give plain decimal numbers; expand xacro first."
    ),
    "E_AUDIT_NAME_TWICE": Code("audit", None, "Two links or two joints have one name.", "Rename all but one."),
    "E_AUDIT_NO_NAME": Code("audit", None, "A link or joint has no name.", "Give it one."),
    "E_AUDIT_LINK_UNKNOWN": Code("audit", None, "A joint names a link that does not exist.", "Name a link of the file, or declare it."),
    "E_AUDIT_JOINT_TYPE": Code("audit", None, "A joint has a type that the format does not know.", "Use one of the format's types."),
    "E_AUDIT_TWO_PARENTS": Code("audit", None, "A link is the child of several joints.", "Keep one; closed loops need MJCF."),
    "E_AUDIT_ROOTS": Code("audit", None, "A file has no root link, or several.", "Connect every link to one root."),
    "E_AUDIT_CIRCLE": Code("audit", None, "Links form a cycle.", "Let one of the joints between them start from a link outside the cycle."),
    "E_AUDIT_MIMIC": Code("audit", None, "A joint mimics a joint that does not exist or does not move.", "Name a joint that moves."),
    "W_AUDIT_NAME": Code("audit", None, "Names contain characters that ROS or USD do not accept.", "Use letters, digits and underscores."),
    "W_AUDIT_LONG_NAME": Code("audit", None, "The robot's name is a whole sentence.", "Give it a short name."),
    "E_AUDIT_NO_INERTIA": Code(
        "audit", None, "A body that moves has a shape but no mass.", "Give it mass and inertia; `--fix` with `--density` computes them."
    ),
    "E_AUDIT_MASSLESS": Code(
        "audit", None, "A link that carries a joint has neither mass nor shape.", "Give it a small mass, or make the chain one joint."
    ),
    "E_AUDIT_MASS": Code("audit", None, "A mass is not positive.", "Give a positive mass."),
    "E_AUDIT_INERTIA": Code("audit", None, "An inertia has a principal moment that is not positive.", "Compute it from the shape."),
    "E_AUDIT_INERTIA_TRIANGLE": Code(
        "audit", None, "The largest moment of an inertia exceeds the sum of the others.", "Compute it from the shape."
    ),
    "W_AUDIT_INERTIA_SHAPE": Code(
        "audit",
        None,
        "An inertia is larger than the body's shape allows.",
        "Compute it from the shape; check its unit and reference point.",
    ),
    "W_AUDIT_COM": Code(
        "audit", None, "A centre of mass lies outside the box of the body's shapes.", "Give it in the link's frame, in metres."
    ),
    "W_AUDIT_DENSITY": Code("audit", None, "A body is denser than osmium, or less dense than air.", "Check the units of mass and mesh."),
    "E_AUDIT_LIMITS_ORDER": Code("audit", None, "A lower limit is above its upper limit.", "Swap the two."),
    "W_AUDIT_NO_LIMITS": Code(
        "audit",
        None,
        "A revolute or prismatic joint has no limits, which readers interpret as zero.",
        "Give lower and upper, or make it continuous.",
    ),
    "W_AUDIT_LOCKED": Code("audit", None, "Both limits of a joint are equal.", "Make it fixed, or open its range."),
    "W_AUDIT_DEGREES": Code("audit", None, "Limits in radians look like degrees.", "Write radians."),
    "W_AUDIT_ENDLESS": Code(
        "audit", None, "A limited joint spans a full turn or more.", "Make it continuous, unless a cable or a thread stops it."
    ),
    "I_AUDIT_ZERO_OUTSIDE": Code("audit", None, "A range excludes zero, where readers place the joint.", "Move the joint's origin."),
    "W_AUDIT_NO_EFFORT": Code(
        "audit", None, "The effort or velocity of a joint that moves is zero or missing.", "State that of its drive."
    ),
    "W_AUDIT_PLACEHOLDER": Code("audit", None, "All joints have the same round effort or velocity.", "State that of each joint's drive."),
    "E_AUDIT_MESH_ABSENT": Code("audit", None, "A mesh file does not exist.", "Add the file, or correct its name."),
    "W_AUDIT_MESH_OUTSIDE": Code(
        "audit", None, "A mesh lies outside the folders that may be read.", "Name the folder that holds both with `--root`."
    ),
    "E_AUDIT_MESH_UNREADABLE": Code("audit", None, "A mesh file cannot be read.", "Export it again."),
    "I_AUDIT_MESH_FORMAT": Code(
        "audit", None, "A mesh has a format that is not read, so its shape is not audited.", "Convert it to STL, OBJ, GLB, PLY or DAE."
    ),
    "W_AUDIT_NO_COLLISION": Code(
        "audit", None, "A link has visual shapes but no collision shapes.", "Use the same mesh or a simpler one for collision."
    ),
    "W_AUDIT_HULL_JAM": Code(
        "audit",
        None,
        "Convex hulls, which simulators collide with, meet where the meshes are apart.",
        "Collide with convex pieces: `audit --fix OUT --collision pieces`.",
    ),
    "W_AUDIT_MESH_OPEN": Code("audit", None, "A mesh has edges with only one triangle, or is not a solid for another reason.", "Close it."),
    "W_AUDIT_MESH_FLAT": Code("audit", None, "A mesh encloses nothing.", "Give it a thickness."),
    "W_AUDIT_MESH_INSIDE_OUT": Code("audit", None, "The triangles of a mesh face inwards.", "Reverse them."),
    "W_AUDIT_PIECES": Code("audit", None, "A link consists of several bodies that do not touch.", "Make each body a link, or join them."),
    "I_AUDIT_UNFUSED": Code("audit", None, "A mesh consists of several bodies that touch but are not fused.", "Fuse them."),
    "W_AUDIT_SCALE": Code("audit", None, "A whole robot is larger than 100 m or smaller than 1 mm.", "Check the unit of its meshes."),
    "W_AUDIT_UNITS": Code("audit", None, "A shape has a different unit than the shapes around it.", "Give it the right scale."),
    "I_AUDIT_BASE": Code(
        "audit", None, "A robot reaches below the origin of its base.", "Spawn it higher, or add a base link at the floor."
    ),
    "W_AUDIT_GLTF": Code(
        "audit", None, "A glTF file is in millimetres, although glTF is in metres.", "Write STL or OBJ, or glTF in metres."
    ),
    "I_AUDIT_CARRIERS": Code(
        "audit", None, "Links without shape represent a joint of several freedoms.", "Use MJCF or CAD, where it is one joint."
    ),
    "I_AUDIT_SHARED": Code(
        "audit",
        None,
        "Shapes overlap whose collision simulators never check.",
        "Nothing needs to be done if the shapes represent bodies that fit.",
    ),
    "W_AUDIT_PAIR_COLLISION": Code(
        "audit", None, "Two parts collide when two joints move together.", "Narrow one range, or add clearance."
    ),
    "W_AUDIT_NOT_CHECKED": Code(
        "audit",
        None,
        "The budget did not suffice for a check, or the kernel's mesh of a solid is not closed.",
        "Raise `--budget`; rebuild such a solid without surfaces that touch along a line.",
    ),
    "W_AUDIT_ENGINE": Code("audit", None, "A simulator does not load the file.", "Correct what its message names."),
    "W_AUDIT_UNNAMED": Code(
        "audit", None, "Parts of a STEP file have no names of their own.", "Name the products before they are exported."
    ),
    "E_AUDIT_NOT_SOLID": Code("audit", None, "A part of a STEP file is not a valid closed solid.", "Repair it in CAD."),
    "E_SIM_LOAD": Code("audit", None, "A simulator does not load the model.", "Audit the file: `articad audit`."),
    "W_SIM_NOT_TRIED": Code(
        "audit", None, "A simulator was stopped before it had finished.", "Simulate the file with more time: `articad sim --seconds`."
    ),
    "E_SIM_EXPLODES": Code(
        "audit", None, "Numbers in a simulation grow without bound.", "Audit the file for overlap and inertias; use a smaller time step."
    ),
    "E_SIM_UNSETTLED": Code("audit", None, "A model whose joints are held does not come to rest.", "Audit the file for overlap at rest."),
    "E_SIM_RANGE": Code("audit", None, "A joint does not reach 99 % of its range.", "Add clearance, or narrow the range."),
    "E_SIM_RESIDUAL": Code(
        "audit", None, "The constraints of closed loops are not met.", "Let the loop close at rest; stiffen the constraint."
    ),
    "I_SIM_LOOPS_OPEN": Code(
        "audit",
        None,
        "A file leaves closed loops of its assembly open; their joints are not driven where bodies collide.",
        "Simulate the MJCF in MuJoCo, which closes them.",
    ),
    "I_SIM_UNREAD": Code(
        "audit",
        None,
        "A simulator does not read the inertia of a link from the file, so it was not tried there.",
        "Simulate a URDF of the model in that engine.",
    ),
    "E_SIM_ENERGY": Code(
        "audit", None, "Energy grows although nothing drives the model.", "Use a smaller time step; check inertias, springs and damping."
    ),
}
