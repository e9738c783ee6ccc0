"""Machines of FreeCAD's machine editor, and the machine files of `post`: what `post-fcm` is made of."""


class Refused(Exception):
    """What cannot be said in the other file."""
