"""Robot joints with a strain wave gear: what is recorded of them, what a textbook says of them, and what that lacks."""
