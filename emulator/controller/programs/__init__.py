"""Programs: how they are stored, prepared and carried out, and what may interrupt them."""
