"""Groundings: make data in physics, train and evaluate samplers and classifiers, serve them."""
