"""Fits of the model's parameters to order lines: priors, regularised Gauss-Newton steps, errors of an effect's form."""
