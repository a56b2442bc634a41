"""One module for each page whose numbers are reproduced."""
