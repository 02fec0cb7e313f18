"""The simulated world: obstacles that move, hide and vanish, and a robot that plans as it goes."""
