"""Signals: functions of time for loads, prescribed motions, motors and servos."""

from dalembert.multibody.components.signals import BSpline, Constant, Custom, Harmonic, Polynomial, Signal, Step, Table

__all__ = ["BSpline", "Constant", "Custom", "Harmonic", "Polynomial", "Signal", "Step", "Table"]
