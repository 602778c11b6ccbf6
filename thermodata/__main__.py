"""`python -m thermodata` is the command line."""

import sys

from thermodata.cli import main

sys.exit(main())
