"""What README.md and docs/manual.md say can be done."""

import follow

follow.main("README.md", "docs/manual.md")
