"""Basics that every room uses: bits, exact numbers, arrays, text, registries, files."""
