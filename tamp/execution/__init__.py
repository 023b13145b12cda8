"""Plans carried out in physics: what follows from them when things have mass, fingers slip, and
somebody interferes.
"""
