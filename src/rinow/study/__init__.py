"""Topics composed into one frozen result."""
