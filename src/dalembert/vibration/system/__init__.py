"""Structures with contacts, springs and forces, and their arrays."""
