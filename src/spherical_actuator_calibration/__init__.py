"""What the programs of scripts/ are made of. Messages and services are beside it, in `msg` and `srv`."""
