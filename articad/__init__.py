"""articad: editable, articulated CAD assemblies from text, images or a plan."""

__version__ = "0.1.0"
