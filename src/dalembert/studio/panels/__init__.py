"""Panels of a study's page, one file each: ``show(draft, services)`` builds a panel that follows the draft."""
