"""Typed commands to closed-form motion of the axes."""
