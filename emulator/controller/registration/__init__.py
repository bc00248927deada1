"""Triggers that latch positions, moves that start from a latched position, and motion that waits for a condition."""
