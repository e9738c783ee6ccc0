"""What `post` needs to know of a LinuxCNC machine: its INI file, its HAL files, its kinematics."""


class Refused(Exception):
    """What cannot be done, each fault with what would help; nothing is written."""

    def __init__(self, *faults: str) -> None:
        super().__init__("\n".join(faults))
        self.faults = list(faults)
