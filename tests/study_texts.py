"""Models of study files that several tests begin with."""

BAR = """
[model]
gravity = [0.0, -9.81]
[[model.body]]
kind = "RigidBar"
name = "bar"
length = 1.0
mass = 1.0
[[model.joint]]
kind = "RevoluteJoint"
name = "pin"
a = "ground"
b = "bar.start"
"""
"""A bar on a pin."""

SLIDER = """
[parameters]
preload = { lower = 0.0, upper = 8.0, start = 1.0 }
[[model.mass]]
name = "m"
mass = 1.0
[[model.spring]]
first = "m"
stiffness = 1.0
damping = 0.04
[[model.force]]
dof = "m"
amplitude = 1.0
[[model.contact]]
name = "slider"
first = "m"
friction = 0.5
preload = "preload"
law = { kind = "ElasticSlider", tangential_stiffness = 0.8 }
"""
"""A mass on a spring, damped by friction of an uncertain preload."""
