"""What goes wrong when a port is opened."""


class PortError(Exception):
    """A port cannot be opened; the text is one line for the user and names the port."""
