"""Plan PDDL problems without scene and robot: classical planning with derived predicates."""
