"""Meshes and matrices from files of other programs."""
