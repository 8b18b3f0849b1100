"""Panels of a study's page, one file each: ``show(draft, room)`` builds a panel that follows the draft."""
