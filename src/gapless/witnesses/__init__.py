"""Witnesses: what a channel says, held against what the other senses know before it is believed."""
