"""`python -m emulator` is the same program as the `oem6250` command."""

import sys

from emulator.cli import main

sys.exit(main())
