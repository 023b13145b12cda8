"""Instantiate lifted tasks: normal form, datalog joins, axioms, lazy guards."""
