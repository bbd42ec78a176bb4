"""Data of a compiled MuJoCo model about bodies, joints and geoms beyond an assembly, as elements that `write_mjcf` writes again.

The compiled model has every default, class, frame, copy and include resolved, so each value is an attribute of its own element here. A
value is carried if it differs from MuJoCo's value for an empty element, which the compiler provides (`_usual`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

import numpy as np
from lxml import etree

from articad.assembly import Kept
from articad.importers.mjcf_compiled import Compiled

__all__ = ["CARRIED", "Carrier"]

Names = Callable[[str, int], str]

_GEOM: Final = {
    name: f"geom_{name}"
    for name in ("contype", "conaffinity", "condim", "group", "priority", "friction", "solmix", "solref", "solimp", "margin", "gap")
} | {"adhesion": "geom_adhesion", "castshadow": "geom_castshadow", "surfacevel": "geom_surfacevel", "user": "geom_user"}
_JOINT: Final = {
    "group": "jnt_group",
    "margin": "jnt_margin",
    "solreflimit": "jnt_solref",
    "solimplimit": "jnt_solimp",
    "springyield": "jnt_springyield",
    "actuatorgravcomp": "jnt_actgravcomp",
    "user": "jnt_user",
}
_DOF: Final = {"armature": "dof_armature", "solreffriction": "dof_solref", "solimpfriction": "dof_solimp"}
_BODY: Final = {"gravcomp": "body_gravcomp", "user": "body_user"}
_SITE: Final = {"group": "site_group", "size": "site_size", "user": "site_user"}
_CAMERA: Final = {"ipd": "cam_ipd", "resolution": "cam_resolution", "user": "cam_user"}
_LIGHT: Final = {
    name: f"light_{name}" for name in ("active", "castshadow", "dir", "attenuation", "cutoff", "exponent", "ambient", "diffuse", "specular")
} | {"bulbradius": "light_bulbradius", "intensity": "light_intensity", "range": "light_range", "softness": "light_softness"}
_BOOLEAN: Final = frozenset({"castshadow", "active", "actuatorgravcomp"})
_LIGHT_TYPES: Final = ("spot", "directional", "point", "image")
_OUTPUTS: Final = ("rgb", "depth", "distance", "normal", "segmentation")
_MODES: Final = ("fixed", "track", "trackcom", "targetbody", "targetbodycom")

CARRIED: Final[Mapping[str, frozenset[str]]] = {
    "geom": frozenset({*_GEOM, "fluidshape", "fluidcoef", "rgba"}),
    "joint": frozenset({*_JOINT, *_DOF, "stiffness", "springref", "springdamper", "ref", "damping"}),
    "freejoint": frozenset({"group"}),
    "body": frozenset({*_BODY, "mocap"}),
    "site": frozenset({*_SITE, "name", "class", "type", "pos", "quat", "axisangle", "euler", "fromto", "xyaxes", "zaxis", "rgba"}),
    "camera": frozenset({*_CAMERA, "name", "class", "mode", "target", "fovy", "pos", "quat", "axisangle", "euler", "xyaxes", "zaxis"})
    | {"sensorsize", "focal", "focalpixel", "principal", "principalpixel", "projection", "output"},
    "light": frozenset({*_LIGHT, "name", "class", "mode", "target", "type", "directional", "pos"}),
}
"""Attributes that are carried, by tag."""


class Carrier:
    """Makes the kept elements of a compiled model."""

    def __init__(self, compiled: Compiled, bodies: list[str], joints: list[str]) -> None:
        self.m, self._usual = compiled, compiled.usual
        self.bodies, self.joints = bodies, joints

    # ------------------------------------------------------------------ elements

    def geom(self, geom: int, where: str) -> Kept:
        """Return a geom's data beyond its shape and pose; `what` is empty if there are none."""
        found = self._attributes(_GEOM, geom, 0)
        fluid = self.m.geom_fluid[geom]
        if fluid[0]:
            found |= {"fluidshape": "ellipsoid", "fluidcoef": _numbers(fluid[1:6])}
        bits = int(self.m.geom_contype[geom]), int(self.m.geom_conaffinity[geom])
        whether = {"contype", "conaffinity"} if bits in {(0, 0), (1, 1)} else set()  # whether it collides is read elsewhere
        said = {name: value for name, value in found.items() if name not in whether}
        name = self._name("GEOM", geom)
        rgba = self.m.mat_rgba[self.m.geom_matid[geom]] if self.m.geom_matid[geom] >= 0 else self.m.geom_rgba[geom]
        if rgba[3] != 1:
            said["transparency"] = f"alpha {rgba[3]:.6g}"
        words = _words(said)
        label = f"geom {name!r}" if name else "a geom"
        whole = ({"name": name} if name else {}) | found | {"rgba": _numbers(rgba)}
        return Kept("mjcf", where, f"{words} of {label}" if words else "", _xml("geom", whole))

    def plane(self, geom: int, where: str) -> Kept:
        """Return a geom that is an infinite plane, completely."""
        element = etree.fromstring(self.geom(geom, where).xml)
        element.attrib.update({"type": "plane", "size": _numbers(self.m.geom_size[geom])} | self._place("geom", geom))
        return Kept("mjcf", where, f"the plane geom {self._name('GEOM', geom)!r}", etree.tostring(element, encoding="unicode"))

    def joint(self, joint: int) -> Iterator[Kept]:
        """Yield a joint's data beyond its axis, limits, damping and friction."""
        m, at, q = self.m, int(self.m.jnt_dofadr[joint]), int(self.m.jnt_qposadr[joint])
        found = self._attributes(_JOINT, joint, 0) | self._attributes(_DOF, at, 0)
        ball, free = m.jnt_type[joint] == m.mjJNT_BALL, m.jnt_type[joint] == m.mjJNT_FREE
        if free:  # the assembly has no dynamics of a free joint
            found |= {
                name: _numbers(getattr(m, f"dof_{name}")[at]) for name in ("damping", "frictionloss") if getattr(m, f"dof_{name}")[at]
            }
        stiffness = [float(m.jnt_stiffness[joint]), *self._more("jnt_stiffnesspoly", joint)]
        if any(stiffness):
            found["stiffness"] = _numbers(stiffness)
        if not ball and not free and m.qpos_spring[q]:
            found["springref"] = _numbers([m.qpos_spring[q]])
        if more := self._more("dof_dampingpoly", at):
            found["damping"] = _numbers([m.dof_damping[at], *more])
        if not ball and not free and m.qpos0[q]:
            found["ref"] = _numbers([m.qpos0[q]])
        if ball and m.jnt_limited[joint]:
            found["range"] = _numbers(m.jnt_range[joint])
        low, high = (float(bound) for bound in m.jnt_actfrcrange[joint])
        if m.jnt_actfrclimited[joint] and low != -high:
            found["actuatorfrcrange"] = _numbers([low, high])
        if found:
            yield Kept("mjcf", f"joints.{self.joints[joint]}", _words(found), _xml("joint", found))

    def body(self, body: int) -> Iterator[Kept]:
        """Yield a body's data beyond joints and geoms: attributes, sites, cameras and lights."""
        m, where = self.m, f"parts.{self.bodies[body]}"
        found = self._attributes(_BODY, body, 0) | ({"mocap": "true"} if m.body_mocapid[body] >= 0 else {})
        if found:
            yield Kept("mjcf", where, _words(found), _xml("body", found))
        for word, prefix, kind, count in (
            ("site", "site", "SITE", m.nsite),
            ("camera", "cam", "CAMERA", m.ncam),
            ("light", "light", "LIGHT", m.nlight),
        ):
            make = {"site": self._site, "camera": self._camera, "light": self._light}[word]
            for index in np.flatnonzero(getattr(m, f"{prefix}_bodyid")[:count] == body).tolist():
                name = self._name(kind, index)
                yield Kept(
                    "mjcf", where, f"{word} {name!r}" if name else f"a {word}", _xml(word, ({"name": name} if name else {}) | make(index))
                )

    def _site(self, site: int) -> dict[str, str]:
        kind = self.m.word("GEOM", int(self.m.site_type[site]))
        rgba = self.m.mat_rgba[self.m.site_matid[site]] if self.m.site_matid[site] >= 0 else self.m.site_rgba[site]
        whole = self._attributes(_SITE, site, 0) | self._place("site", site) | {"rgba": _numbers(rgba)}
        return whole | ({"type": kind} if kind != "sphere" else {})

    def _camera(self, camera: int) -> dict[str, str]:
        m = self.m
        found = self._attributes(_CAMERA, camera, 0) | self._place("cam", camera) | self._looks("cam", camera)
        if m.cam_sensorsize[camera].all():
            intrinsic = m.cam_intrinsic[camera]
            found |= {
                "sensorsize": _numbers(m.cam_sensorsize[camera]),
                "focal": _numbers(intrinsic[:2]),
                "principal": _numbers(intrinsic[2:]),
            }
        else:
            found["fovy"] = _numbers([m.cam_fovy[camera]])
        orthographic = bool(m.cam_projection[camera]) if hasattr(m, "cam_projection") else bool(m.cam_orthographic[camera])
        if hasattr(m, "cam_output") and int(m.cam_output[camera]) != int(self._usual.cam_output[0]):
            found["output"] = " ".join(word for bit, word in enumerate(_OUTPUTS) if int(m.cam_output[camera]) >> bit & 1)
        return found | ({"projection": "orthographic"} if orthographic else {})

    def _light(self, light: int) -> dict[str, str]:
        found = self._attributes(_LIGHT, light, 0) | {"pos": _numbers(self.m.light_pos[light])} | self._looks("light", light)
        kind = int(self.m.light_type[light]) if hasattr(self.m, "light_type") else int(self.m.light_directional[light])
        return found | ({"type": _LIGHT_TYPES[kind]} if kind else {})

    # ------------------------------------------------------------------ values

    def _name(self, kind: str, index: int) -> str:
        return self.m.name(kind, index)

    def _place(self, prefix: str, index: int) -> dict[str, str]:
        return {name: _numbers(getattr(self.m, f"{prefix}_{name}")[index]) for name in ("pos", "quat")}

    def _looks(self, prefix: str, index: int) -> dict[str, str]:
        """Return what a camera or a light follows, and how."""
        mode, target = int(getattr(self.m, f"{prefix}_mode")[index]), int(getattr(self.m, f"{prefix}_targetbodyid")[index])
        return ({"mode": _MODES[mode]} if mode else {}) | ({"target": self.bodies[target]} if target >= 0 else {})

    def _more(self, name: str, index: int) -> list[float]:
        """Return the higher coefficients of a polynomial, empty if they are all zero."""
        values = getattr(self.m, name)[index].tolist() if hasattr(self.m, name) else []
        return values if any(values) else []

    def _attributes(self, table: Mapping[str, str], index: int, usual: int) -> dict[str, str]:
        """Return the attributes with unusual values."""
        found = {}
        for name, field in table.items():
            if not hasattr(self.m, field):  # of a later MuJoCo
                continue
            value, normal = np.atleast_1d(getattr(self.m, field)[index]), np.atleast_1d(getattr(self._usual, field)[usual])
            if value.size and not (np.array_equal(value, normal) if value.size == normal.size else not value.any()):
                found[name] = ("true" if value[0] else "false") if name in _BOOLEAN else _numbers(value)
        return found


def _numbers(values: Any) -> str:
    return " ".join(repr(float(value)).removesuffix(".0") if math.isfinite(value) else str(value) for value in np.atleast_1d(values))


def _words(attributes: Mapping[str, str]) -> str:
    return ", ".join(
        f"{name} {' '.join(f'{float(word):.6g}' if _is_number(word) else word for word in value.split())}"
        for name, value in attributes.items()
    )


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _xml(tag: str, attributes: Mapping[str, str]) -> str:
    return str(etree.tostring(etree.Element(tag, dict(attributes)), encoding="unicode"))
