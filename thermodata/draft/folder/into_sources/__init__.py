"""Files into sources: what one logger wrote, whatever its files are called and however their signals are named."""
