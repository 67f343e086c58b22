"""Reads, condenses and draws what `qtrace run` wrote."""
