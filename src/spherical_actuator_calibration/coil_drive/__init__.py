"""Turning the rotor by its own coils, through the orientation controller. See scripts/track_orientation."""
