"""The workbench: pages of a local server over one store. What they show comes from the floors below."""
