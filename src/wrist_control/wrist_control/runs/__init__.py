"""What a recording of one wrist tells: its commands again, and a report."""
