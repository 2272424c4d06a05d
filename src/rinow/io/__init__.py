"""Files in and out; paths are known here only."""
