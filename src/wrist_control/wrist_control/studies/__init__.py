"""The papers and the comparisons, computed and drawn again."""
