"""What nobody logged: the heat that would explain the residual, what it goes with, and where to look for it."""
