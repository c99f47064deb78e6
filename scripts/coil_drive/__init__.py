"""Turning the rotor by its own coils, through the orientation controller. See ../track_orientation."""
