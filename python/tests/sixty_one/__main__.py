"""``PYTHONPATH=python/tests python3 -m sixty_one``: posts the machines and prints the table; ``--table`` writes it
into the book. The command is POST_COMMAND, or that of target/debug."""

from __future__ import annotations

import sys

from sixty_one.page import PAGE, text, verdicts

found = text(verdicts())
if sys.argv[1:] == ["--table"]:
    PAGE.write_text(found)
elif sys.argv[1:]:
    sys.exit(__doc__)
else:
    sys.stdout.write(found)
