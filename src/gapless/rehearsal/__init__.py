"""Rehearsal: outages replayed in the good past tell which bridge has earned to speak, and how sure it is."""
