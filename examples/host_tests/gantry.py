"""A small host library: two axes as one machine that goes to places given in millimetres."""

from clients import OEM6250

COUNTS_PER_MM = 400
SAFE_VELOCITY, SAFE_ACCELERATION = 4.0, 40.0


class Gantry:
    """Axis 1 is x, axis 2 is y; where it stands when it is switched on is the origin."""

    def __init__(self, ctl: OEM6250) -> None:
        self.ctl = ctl

    def switch_on(self) -> None:
        for axis in (self.ctl.axis[1], self.ctl.axis[2]):
            axis.drive_enabled = True
            axis.velocity = SAFE_VELOCITY
            axis.acceleration = axis.deceleration = SAFE_ACCELERATION
            axis.set_position(0)

    def switch_off(self) -> None:
        self.ctl.kill()
        for axis in (self.ctl.axis[1], self.ctl.axis[2]):
            axis.drive_enabled = False

    def go(self, *, x_mm: float, y_mm: float) -> None:
        """Both axes together; returns when both have settled.

        Raises:
            clients.UnitError: the controller refuses. clients.MotionError: an axis ended elsewhere.
        """
        self.ctl.move_to({1: round(x_mm * COUNTS_PER_MM), 2: round(y_mm * COUNTS_PER_MM)})

    @property
    def place_mm(self) -> tuple[float, float]:
        return self.ctl.axis[1].position / COUNTS_PER_MM, self.ctl.axis[2].position / COUNTS_PER_MM
