"""Components: bodies, joints, loads, and what every one of them offers."""
