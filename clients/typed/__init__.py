"""What `python -m clients.generate` makes of the catalogue: typed commands and status words."""
