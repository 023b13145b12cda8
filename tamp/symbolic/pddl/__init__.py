"""Parse and check PDDL and PDDLStream files into frozen formulas, actions, rules, streams."""
