"""Following: slave axes that move by master travel, with phase shifts, master cycles and what they report."""
