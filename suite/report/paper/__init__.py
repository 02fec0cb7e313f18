"""The paper's figures beside ours, and what the two say about each other."""
