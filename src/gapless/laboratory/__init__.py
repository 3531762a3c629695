"""The outage laboratory: systems, recordings, scenarios in; scores that cannot be fooled out."""
