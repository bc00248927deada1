"""`python -m clients PORT`: the interactive terminal (docs/terminal.md)."""

import sys

from clients.terminal.command import main

sys.exit(main())
