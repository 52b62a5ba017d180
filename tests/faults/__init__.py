"""Stages that fail in every way there is, and a gateway that stays up."""
