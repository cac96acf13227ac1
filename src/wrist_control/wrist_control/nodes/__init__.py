"""What people run, one file a node: they convert, call and publish; no mathematics."""
