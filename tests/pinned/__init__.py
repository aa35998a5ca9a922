"""Behaviour pinned across changes that must change no result."""
