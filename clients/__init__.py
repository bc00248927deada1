"""What a host program or a test imports to talk to a unit, emulated or physical."""

from clients.line_client import DEFAULT_PROMPTS, LineClient, UnitTimeout

__all__ = ["DEFAULT_PROMPTS", "LineClient", "UnitTimeout"]
