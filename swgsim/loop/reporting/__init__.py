"""The answer as plain numbers and text."""
