"""How sure each parameter and gain is: by slopes and scatter, or by its profile."""
