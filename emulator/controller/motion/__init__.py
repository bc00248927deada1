"""Motion: GO, stops, limits, drives and gains, homing, jogging, joystick."""
