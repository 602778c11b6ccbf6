"""The channels of a file: what each is, its scaling, and the clock that its properties state."""
